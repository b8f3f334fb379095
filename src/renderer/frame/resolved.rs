//! Draw items, checked and resolved: the one place where a draw's factor is limited.

use super::Renderer;
use crate::constants::{COUNTER_CLOCKWISE_FLAG, INSIDE_FLAG};
use crate::renderer::evaluate::Drawn;
use crate::renderer::model::Model;
use crate::renderer::options::{DrawItem, Error, Factor, Geometry, Style, View, is_size};
use crate::renderer::shader::{DrawConstants, ItemRecord, displacement_flags};
use glam::Mat4;

/// A draw item that can be drawn, with what it names.
pub(crate) struct ResolvedItem<'r> {
    pub item: &'r DrawItem,
    pub model: &'r Model,
    pub style: &'r Style,
    /// What the surface is drawn from; none where the control mesh is drawn.
    pub drawn: Option<Drawn<'r>>,
    /// The largest factor of an edge.
    pub most: f32,
    /// What shaders know of the item.
    pub record: ItemRecord,
    /// Constants of the draws, for no patches yet.
    pub constants: DrawConstants,
}

impl Renderer {
    /// A draw item with the number behind [`Factor::Segments`] in its place.
    ///
    /// # Errors
    /// Unknown styles and models; [`Error::NoSegments`], [`Error::OwnSegments`], [`Error::SegmentsNotSet`].
    pub(crate) fn with_segments(&self, item: &DrawItem) -> Result<DrawItem, Error> {
        let (id, surface) = (item.model, self.style(item)?.geometry == Geometry::Surface);
        let model = self.model(id)?;
        let evaluation = model.options.evaluation;
        match (item.factor, evaluation.needs_segments()) {
            (Factor::Segments, true) if surface && model.uniform_grid.is_none() => Err(Error::SegmentsNotSet { id }),
            (Factor::Segments, true) => Ok(DrawItem { factor: model.own_factor(), ..*item }),
            (Factor::Segments, false) => Err(Error::NoSegments { id, evaluation }),
            (factor, true) if surface => Err(Error::OwnSegments { id, evaluation, factor }),
            _ => Ok(*item),
        }
    }

    /// Checks and resolves a draw item, which [`Renderer::with_segments`] made.
    ///
    /// # Errors
    /// Unknown styles and models, models that were not prepared, factors and displacements that are none.
    pub(crate) fn resolve<'r>(&'r self, view: &View, item: &'r DrawItem) -> Result<ResolvedItem<'r>, Error> {
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
            Factor::Segments => (1.0, 1.0),
        };
        let drawn = (style.geometry == Geometry::Surface).then(|| model.drawn(factor)).transpose()?;
        let segments = drawn.and_then(Drawn::segments).unwrap_or(0);
        // Of instances, shaders see themselves which are mirrored.
        let is_mirrored = item.instances.is_none() && Mat4::from_cols_array_2d(&item.transform).determinant() < 0.0;
        let back = match style.culls_counter_clockwise(view) {
            Some(true) => COUNTER_CLOCKWISE_FLAG,
            Some(false) => 0,
            None if is_mirrored => COUNTER_CLOCKWISE_FLAG | INSIDE_FLAG,
            None => INSIDE_FLAG,
        };
        let record = ItemRecord::of(item, &model.map, value, segments);
        let constants = DrawConstants::new(displacement_flags(&model.map) | back);
        Ok(ResolvedItem { item, model, style, drawn, most, record, constants })
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
