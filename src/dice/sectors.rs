//! The vertices at the corners of facets: one for each sector between edges along which normals or texture coordinates differ.

use super::layout::Split;
use crate::mesh::SHARPNESS_INFINITE;
use crate::topology::Topology;
use rustc_hash::FxHashMap;

/// Who writes a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Own,
    /// It has the position of another vertex.
    Copy,
    Other,
}

/// The corners of all facets. A facet corner has the number of the half-edge that starts there.
pub(super) struct Corners {
    pub roles: Vec<Role>,
    /// The corner that writes the vertex of each corner.
    pub writers: Vec<u32>,
    /// The corners that write the position and the normal that each copy has.
    pub sources: FxHashMap<u32, [u32; 2]>,
    /// Corners around vertices without a tangent plane, first the one that writes the vertex.
    pub blunt: Vec<Vec<u32>>,
}

impl Corners {
    pub(super) fn new(topology: &Topology, depths: &[Option<u32>], splits: &impl Fn(u32) -> Split) -> Self {
        let count = topology.mesh().corner_count();
        let mut corners = Self {
            roles: vec![Role::Other; count],
            writers: vec![u32::MAX; count],
            sources: FxHashMap::default(),
            blunt: Vec::new(),
        };
        let mut seen = vec![false; count];
        for h in 0..count as u32 {
            if seen[h as usize] {
                continue;
            }
            let (fan, open) = topology.fan(h);
            fan.iter().for_each(|&h| seen[h as usize] = true);
            corners.add_fan(&Fan::new(topology, fan, open, depths, splits));
        }
        corners
    }

    fn add_fan(&mut self, fan: &Fan) {
        for run in &fan.runs {
            let owner = run[0];
            let mut of_normal = owner;
            let mut writer = owner;
            let mut around: Vec<u32> = Vec::new();
            for &h in run {
                let split = if h == owner { Split::default() } else { fan.split(h) };
                if split.crease {
                    self.add_blunt(fan, std::mem::take(&mut around));
                    of_normal = h;
                }
                around.push(h);
                if split.any() {
                    writer = h;
                    self.sources.insert(h, [owner, of_normal]);
                    self.roles[h as usize] = Role::Copy;
                }
                self.writers[h as usize] = writer;
            }
            self.add_blunt(fan, around);
            self.roles[owner as usize] = Role::Own;
        }
    }

    fn add_blunt(&mut self, fan: &Fan, around: Vec<u32>) {
        if around.len() > 1 && fan.is_blunt {
            self.blunt.push(around);
        }
    }
}

/// The faces around a vertex that are drawn.
struct Fan {
    /// Half-edges of faces next to each other. If a run is closed, it begins where it is split.
    runs: Vec<Vec<u32>>,
    /// Those that are split from the half-edge before.
    splits: Vec<(u32, Split)>,
    /// Whether there is no tangent plane where several faces meet in a sector.
    is_blunt: bool,
}

impl Fan {
    fn new(
        topology: &Topology,
        mut fan: Vec<u32>,
        open: bool,
        depths: &[Option<u32>],
        splits: &impl Fn(u32) -> Split,
    ) -> Self {
        let is_sharp = |h: &&u32| topology.twin(**h).is_some() && topology.sharpness(**h) >= SHARPNESS_INFINITE;
        let creases = fan.iter().filter(is_sharp).count() + if open { 2 } else { 0 };
        let tagged = topology.vertex_sharpness(topology.mesh_vertex(fan[0])) >= SHARPNESS_INFINITE;
        let is_blunt = tagged || creases > 2 || !open && creases == 0 && fan.len() == 2;
        // A single crease ends here: the normal is the same all around.
        let split_at = |h: u32| Split { crease: splits(h).crease && creases > 1, ..splits(h) };
        let mut cuts: Vec<(u32, Split)> = fan.iter().map(|&h| (h, split_at(h))).filter(|(_, s)| s.any()).collect();
        let is_drawn = |h: &u32| depths[*h as usize / 4].is_some();
        if !open && fan.iter().all(is_drawn) {
            match cuts.as_slice() {
                [] => {}
                // One cut leaves a closed sector whole.
                [_] => cuts.clear(),
                _ => {
                    let first = cuts.iter().find(|(_, s)| s.crease).unwrap_or(&cuts[0]).0;
                    let at = fan.iter().position(|&h| h == first).unwrap_or(0);
                    fan.rotate_left(at);
                }
            }
            return Self { runs: vec![fan], splits: cuts, is_blunt };
        }
        if !open {
            let gap = fan.iter().position(|h| !is_drawn(h)).unwrap_or(0);
            fan.rotate_left(gap);
        }
        let runs = fan.split(|h| !is_drawn(h)).filter(|run| !run.is_empty()).map(<[u32]>::to_vec).collect();
        Self { runs, splits: cuts, is_blunt }
    }

    fn split(&self, h: u32) -> Split {
        self.splits.iter().find(|(other, _)| *other == h).map_or(Split::default(), |(_, split)| *split)
    }
}
