//! Evaluation and construction of the patches.

use super::error::CliError;
use super::parse::{self, Maker};
use ash_subdiv::Construction;
use ash_subdiv::renderer::Evaluation;
use clap::Args;

#[derive(Debug, Args)]
pub(super) struct EvaluationArgs {
    /// Evaluation of the patches. All but the tessellation stages give every edge as many segments as --factor says,
    /// rounded up. cpu needs no patches: points of the limit surface, their segments rounded up to a power of two.
    #[arg(long, value_name = "WHAT", default_value = Evaluation::Tessellation.name(), value_parser = parse::maker())]
    pub(super) evaluation: Maker,
    /// Construction of the control points on the GPU; if not given, as is usual with the evaluation (two-stage with tessellation).
    #[arg(long, value_name = "HOW", value_parser = parse::one_of(Construction::ALL, Construction::name))]
    construction: Option<Construction>,
}

impl EvaluationArgs {
    /// The construction; `given` are further arguments, and whether they were given, that only the tessellation stages go
    /// with, `shares` is one that was given and has patches share more than positions.
    pub(super) fn construction(&self, given: &[(&str, bool)], shares: Option<&str>) -> Result<Construction, CliError> {
        let name = self.evaluation.name();
        let wrong = |what: &str| CliError::Usage(format!("--evaluation {name}: it does not go with {what}"));
        let given =
            given.iter().filter(|(_, given)| *given && self.evaluation != Maker::Device(Evaluation::Tessellation));
        let Maker::Device(evaluation) = self.evaluation else {
            let construction = self.construction.map(|_| "--construction");
            return match given.map(|(what, _)| *what).chain(shares).chain(construction).next() {
                Some(what) => Err(wrong(&format!("{what}: leave one of both out"))),
                None => Ok(Construction::default()),
            };
        };
        let known = evaluation.constructions().iter().copied();
        let known: Vec<_> = known.filter(|&c| shares.is_none() || evaluation.shares(c)).collect();
        let given = given.map(|(what, _)| *what).chain(shares.filter(|_| known.is_empty())).next();
        if let Some(what) = given {
            return Err(wrong(&format!("{what}: leave one of both out")));
        }
        match self.construction {
            None => Ok(known[0]),
            Some(construction) if known.contains(&construction) => Ok(construction),
            Some(construction) => {
                let names: Vec<_> = known.iter().map(|construction| construction.name()).collect();
                let names = names.join(" or ");
                let with = shares.map(|what| format!(" with {what}")).unwrap_or_default();
                Err(wrong(&format!("--construction {}{with}: choose {names}, or leave it out", construction.name())))
            }
        }
    }
}
