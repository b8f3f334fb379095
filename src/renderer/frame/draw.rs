//! Recording the draws of a view.

use super::resolved::ResolvedItem;
use super::visible::ItemLists;
use super::{Frame, Renderer};
use crate::renderer::evaluate::{Bound, BoundUniformGrid, Drawn, DrawnGroup, Place, Recorder, path};
use crate::renderer::options::{Cull, DrawItem, Error, Factor, Geometry, ModelId, Style, View};
use crate::renderer::shader::{Cut, GeometryKey, PipelineKey, ViewData};
#[cfg(doc)]
use crate::table::Evaluation;
use ash::vk;

impl Renderer {
    /// Records the draws of one view: items in their order, the kinds of patches of each in any. Viewport and scissor are the
    /// caller's to set. Binds sets 0 and 1, pipelines, index and vertex buffers; push constants are overwritten, and the topology
    /// and rasterizer discard where those are dynamic.
    ///
    /// # Errors
    /// [`Error::OldFrame`], [`Error::FrameNotPrepared`]; unknown models and styles, factors below 1, more items than 2^23 and more views than
    /// [`Options::views_per_frame`](crate::renderer::Options::views_per_frame). Items before the wrong one are recorded.
    ///
    /// # Safety
    /// `cmd` is being recorded, inside rendering that fits the [`Target`](crate::renderer::Target) of the items' styles, after
    /// [`Renderer::cmd_prepare`] of the same frame. The caller's sets from 2 on are bound, with layouts as in
    /// [`Options::set_layouts`](crate::renderer::Options::set_layouts).
    pub unsafe fn cmd_draw(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: Frame,
        view: &View,
        items: &[DrawItem],
    ) -> Result<(), Error> {
        self.check_prepared(frame)?;
        let frame_index = frame.index();
        let view_offset = self.take_view(frame_index, view)?;
        self.make_room(frame_index, 0, items.len())?;
        let lists = &mut self.lists[frame_index as usize];
        let (set, mut records) = (lists.set.raw(), std::mem::take(&mut lists.records));
        let mut bound = Bound::default();
        let drawn = items.iter().try_for_each(|item| {
            let item = self.with_segments(item)?;
            if item.instances.is_some_and(|instances| instances.count() == 0) {
                return Ok(());
            }
            let placed = self.place_instances(frame, &item)?;
            self.make_cuts(
                item.model,
                Cut::new(item.factor, item.cull).of_instances(placed.is_some()),
                item.factor,
                false,
            )?;
            let resolved = self.resolve(view, &item)?;
            let record = records.push(&resolved.record)?;
            let (set, instances) = placed.map_or((set, None), |(set, instances)| (set, Some(instances)));
            let place = Place { set, view: view_offset, record, instances };
            // SAFETY: as the caller promises.
            unsafe { self.cmd_draw_item(cmd, place, &resolved, None, &mut bound) }
        });
        self.lists[frame_index as usize].records = records;
        drawn
    }

    /// Writes what the shaders know of a view, and tells where that is.
    pub(crate) fn take_view(&mut self, frame: u32, view: &View) -> Result<u32, Error> {
        let max = self.options.views_per_frame;
        let drawn = &mut self.views_drawn[frame as usize];
        if *drawn >= max {
            return Err(Error::TooManyViews { max });
        }
        let offset = ViewData::STRIDE * (u64::from(frame) * u64::from(max) + u64::from(*drawn));
        *drawn += 1;
        self.views.write(offset, &[ViewData::new(view)])?;
        Ok(offset as u32)
    }

    /// Makes the pipelines for draws of a model with such factors and culling, whatever the number in the factor (but each
    /// level of [`Evaluation::Subdivision`] has its own). Those for [`Factor::Uniform`] (level 0) with [`Cull::NONE`] are there
    /// when the model is added; others are made by the first draw that needs them, unless this was called before.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`]; failed Vulkan calls.
    pub fn make_pipelines(&mut self, id: ModelId, factor: Factor, cull: Cull) -> Result<(), Error> {
        let factor = if factor == Factor::Segments { self.model(id)?.own_factor() } else { factor };
        if self.options.visible_lists && cull != Cull::NONE && self.model(id)?.options.evaluation.culls() {
            self.make_cuts(id, Cut::new(factor, cull), factor, true)?;
        }
        self.make_cuts(id, Cut::new(factor, cull), factor, false)
    }

    /// As [`Renderer::make_pipelines`], for draws of [`DrawItem::instances`], none of whose pipelines are there when the model is added.
    ///
    /// # Errors
    /// As [`Renderer::make_pipelines`].
    pub fn make_instance_pipelines(&mut self, id: ModelId, factor: Factor, cull: Cull) -> Result<(), Error> {
        let factor = if factor == Factor::Segments { self.model(id)?.own_factor() } else { factor };
        self.make_cuts(id, Cut::new(factor, cull).of_instances(true), factor, false)
    }

    /// As [`Renderer::make_pipelines`], for draws of lists only, or for others only.
    pub(crate) fn make_cuts(&mut self, id: ModelId, cut: Cut, factor: Factor, lists: bool) -> Result<(), Error> {
        let model = self.models.get_mut(&id).ok_or(Error::NoSuchModel { id })?;
        // Of patches that are not looked at, all are drawn.
        let cuts = if lists { [Cut::new(factor, Cull::NONE), Cut::listed(factor)] } else { [cut; 2] };
        for each in cuts {
            let level = path(model.options.evaluation).level(factor);
            if !model.made.iter().any(|made| made.is_of(each, level)) {
                let made = self.pipelines.make(&model.stages, each, factor)?;
                if model.tables.refinement().is_some() {
                    self.pipelines.cached.make_refinement(&self.pipelines.draws.shaders)?;
                }
                model.made.push(made);
            }
        }
        if lists {
            let mut listed = model.stages.iter().filter(|stages| stages.has_hull());
            listed.try_for_each(|&stages| self.list_pipelines.make(stages, cut, &self.pipelines.draws.shaders))?;
        }
        Ok(())
    }

    /// Records the draws of an item, of the patches on lists where there are lists.
    ///
    /// # Safety
    /// As [`Renderer::cmd_draw`].
    pub(crate) unsafe fn cmd_draw_item(
        &self,
        cmd: vk::CommandBuffer,
        place: Place,
        resolved: &ResolvedItem,
        lists: Option<ItemLists>,
        bound: &mut Bound,
    ) -> Result<(), Error> {
        let &ResolvedItem { model, drawn, constants, .. } = resolved;
        let (device, layout) = (self.context.device(), self.pipelines.draws.layout.raw());
        let properties = self.context.properties();
        let mut recorder = Recorder { device, properties, layout, cmd, place, bound, constants };
        // SAFETY: as the caller of `cmd_draw` promises.
        unsafe {
            recorder.bind_item(model.set.raw);
            if let Some(drawn) = drawn {
                let lists = lists.filter(|lists| !lists.is_empty());
                self.cmd_draw_surface(&mut recorder, resolved, drawn, lists)
            } else {
                self.cmd_draw_control(&mut recorder, resolved);
                Ok(())
            }
        }
    }

    /// Records the draw of the control mesh.
    unsafe fn cmd_draw_control(&self, recorder: &mut Recorder, resolved: &ResolvedItem) {
        let &ResolvedItem { item, model, style, .. } = resolved;
        let (device, cmd) = (recorder.device, recorder.cmd);
        recorder.bound.uniform_grid = BoundUniformGrid::default();
        let instances = item.instances.is_some();
        let key = PipelineKey { style: item.style, geometry: GeometryKey::Control, instances };
        // SAFETY: as the caller of `cmd_draw` promises.
        unsafe {
            self.bind(cmd, style, self.pipelines.draws.get(key), recorder.bound);
            if let Some(control) = &model.control {
                let (first, count) = match style.geometry {
                    Geometry::ControlEdges => (0, control.edges),
                    _ => (control.edges, control.faces),
                };
                device.cmd_bind_index_buffer(cmd, control.buffer.raw(), 0, vk::IndexType::UINT32);
                recorder.cmd_draw_instances(1, |recorder, instances| {
                    recorder.push();
                    device.cmd_draw_indexed(cmd, count, instances, first, 0, 0);
                });
            }
        }
    }

    /// Records the draws of the surface, group by group.
    unsafe fn cmd_draw_surface(
        &self,
        recorder: &mut Recorder,
        resolved: &ResolvedItem,
        drawn: Drawn,
        lists: Option<ItemLists>,
    ) -> Result<(), Error> {
        let &ResolvedItem { item, model, style, most, .. } = resolved;
        lists.map_or(Ok(()), |lists| lists.check(drawn))?;
        match drawn.uniform_grid() {
            // SAFETY: as the caller of `cmd_draw` promises.
            Some(uniform_grid) => unsafe {
                uniform_grid.cmd_bind(recorder.device, recorder.cmd, &mut recorder.bound.uniform_grid)
            },
            None => recorder.bound.uniform_grid = BoundUniformGrid::default(),
        }
        let path = path(model.options.evaluation);
        let level = path.level(item.factor);
        let made = |cut| model.made.iter().find(|made| made.is_of(cut, level));
        let cull = if lists.is_some() { Cull::NONE } else { item.cull };
        let of_all = made(Cut::new(item.factor, cull).of_instances(item.instances.is_some()));
        let of_lists = lists.and_then(|_| made(Cut::listed(item.factor)));
        let groups = model.tables.plan().groups();
        let pipeline = |number: usize| {
            let made = of_lists.filter(|_| model.stages[number].has_hull()).or(of_all)?;
            Some(made.of(number, item.style))
        };
        // Of many models, every other one is drawn from the last kind of patch to the first: its pipeline is bound already.
        let backwards = groups.len() > 1 && pipeline(groups.len() - 1) == Some(recorder.bound.pipeline);
        for i in 0..groups.len() {
            let number = if backwards { groups.len() - 1 - i } else { i };
            let (stages, group) = (model.stages[number], &groups[number]);
            recorder.constants.set_kind(stages.kind);
            // SAFETY: as the caller of `cmd_draw` promises.
            unsafe { self.bind(recorder.cmd, style, pipeline(number), recorder.bound) };
            if let Some(lists) = lists.filter(|_| stages.has_hull()) {
                // SAFETY: as the caller of `cmd_draw` promises.
                unsafe { self.cmd_draw_lists(recorder, lists, (model, number)) };
                continue;
            }
            recorder.constants.first_corner = group.first_corner as u32;
            recorder.constants.first_patch = group.patches.start as u32;
            let control_points = model.control_points.as_ref();
            // SAFETY: as the caller of `cmd_draw` promises.
            unsafe { path.cmd_draw(recorder, drawn, &DrawnGroup { number, stages, group, most, control_points }) };
        }
        Ok(())
    }

    unsafe fn bind(&self, cmd: vk::CommandBuffer, style: &Style, pipeline: Option<vk::Pipeline>, bound: &mut Bound) {
        let device = self.context.device();
        // Every pipeline of the model was made before.
        if let Some(pipeline) = pipeline
            && bound.pipeline != pipeline
        {
            bound.pipeline = pipeline;
            // SAFETY: as the caller of `cmd_draw` promises.
            unsafe { device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::GRAPHICS, pipeline) };
            if style.rasterizer_discard && !bound.discards {
                // SAFETY: as the caller of `cmd_draw` promises.
                unsafe { device.cmd_set_rasterizer_discard_enable(cmd, true) };
            }
            bound.discards = style.rasterizer_discard;
        }
    }
}
