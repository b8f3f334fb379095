//! Draw items, checked and resolved: the one place where a draw's factor is limited.

use super::Renderer;
use crate::constants::COUNTER_CLOCKWISE_FLAG;
use crate::renderer::model::Model;
use crate::renderer::options::{DrawItem, Error, Factor, Style, View, is_size};
use crate::renderer::shader::DrawConstants;

/// A draw item that can be drawn, with what it names.
pub(crate) struct ResolvedItem<'r> {
    pub model: &'r Model,
    pub style: &'r Style,
    /// The largest factor of an edge.
    pub most: f32,
    /// Constants of the draws, for all patches.
    pub constants: DrawConstants,
}

impl Renderer {
    /// Checks and resolves a draw item.
    ///
    /// # Errors
    /// Unknown styles and models, models that were not prepared, factors and displacements that are none.
    pub(crate) fn resolve(&self, view: &View, item: &DrawItem) -> Result<ResolvedItem<'_>, Error> {
        let style = self.style(item)?;
        let (id, factor) = (item.model, item.factor);
        let model = self.model(id)?;
        if !model.prepared {
            return Err(Error::NotPrepared { id });
        }
        if !factor.is_valid() {
            return Err(Error::BadFactor { id, factor });
        }
        if !is_size(view.measured().viewport) && (factor.needs_viewport() || item.cull.small) {
            return Err(Error::NoViewport { id });
        }
        let [scale, bias] = item.displacement;
        if !(scale.is_finite() && bias.is_finite()) {
            return Err(Error::BadDisplacement { id, scale, bias });
        }
        let max = self.context.properties().max_tessellation_level as f32;
        let (value, most) = match factor {
            Factor::Uniform(factor) => (factor.min(max), factor.min(max)),
            Factor::Pixels(length) | Factor::Curvature(length) => (length, max),
            Factor::Edges(scale) => {
                let largest = model.largest_edge_factor().ok_or(Error::NoEdgeFactors { id })?;
                (scale, (scale * largest).clamp(1.0, max))
            }
        };
        let back = if style.leaves_out_counter_clockwise(&item.transform, view) { COUNTER_CLOCKWISE_FLAG } else { 0 };
        let flags = model.displacement_flags(item.displacement) | back;
        let constants = DrawConstants { flags, ..DrawConstants::new(&item.transform, [value, scale, bias]) };
        Ok(ResolvedItem { model, style, most, constants })
    }

    /// The style of a draw item.
    ///
    /// # Errors
    /// [`Error::NoSuchStyle`].
    pub(crate) fn style(&self, item: &DrawItem) -> Result<&Style, Error> {
        let styles = self.pipelines.draws.styles();
        styles.get(item.style).ok_or(Error::NoSuchStyle { given: item.style, count: styles.len() })
    }
}
