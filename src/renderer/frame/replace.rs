//! Models whose tables change.

use super::{Renderer, RetiredObject};
use crate::mesh::ControlMesh;
use crate::renderer::evaluate::UniformGrid;
use crate::renderer::model::{Model, Surroundings};
use crate::renderer::options::{Cull, DisplacementMap, Error, Factor, ModelId, ModelOptions};
use crate::table::ModelTables;

impl Renderer {
    /// Gives a model another mesh, such as the same with other sharpness ([`ControlMesh::with_sharpness`]), from the next
    /// [`Renderer::cmd_prepare`] on, before which it cannot be drawn any more. Its options stay, and its segments; positions are those
    /// of the mesh, and so are the factors of edges but where the edges are the same.
    ///
    /// It takes the time of [`Renderer::add_model`], most of it for the tables: [`Renderer::set_tables`] takes those that another thread
    /// built. The tables of before go when [`Options::frames_in_flight`](crate::renderer::Options::frames_in_flight) frames have begun since.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`], and as [`Renderer::add_model`]. The model is as it was before.
    pub fn set_mesh(&mut self, id: ModelId, mesh: &ControlMesh) -> Result<(), Error> {
        let tables = ModelTables::new(mesh, &self.model(id)?.options)?;
        self.set_tables(id, tables, &mesh.positions_f32())
    }

    /// As [`Renderer::set_mesh`], with tables that were built elsewhere, such as on another thread, with the model's options.
    ///
    /// # Errors
    /// As [`Renderer::set_mesh`]; [`Error::PositionCount`], [`Error::OtherTables`], [`Error::OtherOption`].
    pub fn set_tables(&mut self, id: ModelId, tables: ModelTables, positions: &[[f32; 3]]) -> Result<(), Error> {
        let before = self.model(id)?;
        let map = before.map;
        let options = ModelOptions { construction: tables.options().construction, ..before.options.clone() };
        let segments = before.uniform_grid.as_ref().map(|uniform_grid| uniform_grid.segments);
        let factors = before.edge_factors_for(&tables);
        let mut model = self.new_model(id, tables, positions, &options, map)?;
        if let Some(segments) = segments {
            let (sharing, plan) = (model.tables.sharing(), &model.tables.plan);
            let uniform_grid =
                UniformGrid::new(&mut self.pipelines.uniform_grid, id, options.evaluation, sharing, plan, segments)?;
            model.set_uniform_grid(uniform_grid);
        }
        if let Some(factors) = factors {
            model.set_edge_factors(0, &factors)?;
        }
        let before = self.models.insert(id, model);
        if let Err(error) = self.make_pipelines(id, Factor::Uniform(1.0), Cull::NONE) {
            self.models.extend(before.map(|before| (id, before)));
            return Err(error);
        }
        // What a frame sent of it is not missed.
        self.begun.forget(id);
        if let Some(before) = before {
            self.retire(None, RetiredObject::Model(Box::new(before)));
        }
        Ok(())
    }

    /// A model that is not yet among the others.
    pub(super) fn new_model(
        &self,
        id: ModelId,
        tables: ModelTables,
        positions: &[[f32; 3]],
        options: &ModelOptions,
        map: DisplacementMap,
    ) -> Result<Model, Error> {
        if positions.len() != tables.control_vertices {
            return Err(Error::PositionCount { id, given: positions.len(), needed: tables.control_vertices });
        }
        let from = Surroundings { context: &self.context, pipelines: &self.pipelines, options: &self.options };
        Model::new(from, id, options, tables, positions, map)
    }
}
