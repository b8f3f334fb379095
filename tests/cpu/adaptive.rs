//! Plans of adaptive subdivision against the limit surface, and against themselves.

use crate::common;
use ash_subdiv::adaptive::{AdaptiveOptions, LEAF, LeafKind, Plan};
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::{ReadOptions, read};
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, Scheme, shape};
use glam::DVec3;

/// A plan with the points of its mesh.
pub(crate) struct Planned {
    pub mesh: ControlMesh,
    pub plan: Plan,
    pub points: Vec<DVec3>,
}

pub(crate) fn positions(mesh: &ControlMesh) -> Vec<DVec3> {
    mesh.data().positions.iter().map(|&p| p.into()).collect()
}

impl Planned {
    pub fn new(mesh: &ControlMesh, scheme: Scheme, options: &AdaptiveOptions) -> Self {
        let plan = Plan::new(&Topology::new(mesh), scheme, options).expect("a plan");
        let points = plan.points(&positions(mesh));
        Self { mesh: mesh.clone(), plan, points }
    }

    pub fn at_depth(mesh: &ControlMesh, depth: u32) -> Self {
        Self::new(mesh, Scheme::Gregory, &AdaptiveOptions { depth, ..AdaptiveOptions::default() })
    }
}

pub(crate) fn shared_mesh(name: &str) -> ControlMesh {
    let path = common::shared().join("meshes").join(name).with_extension("obj");
    read(path, &ReadOptions { drop_isolated: true, ..ReadOptions::default() }).expect("a mesh")
}

/// How far a plan is from the limit surface, over the diagonal: at leaves that are exact, and at end caps.
#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct Distance {
    pub exact: f64,
    /// Of derivatives at exact leaves, over the longer one.
    pub slope: f64,
    pub caps: f64,
    /// Of caps, along the normal of the limit surface.
    pub lift: f64,
}

pub(crate) fn distance(planned: &Planned, surface: &LimitSurface) -> Distance {
    let Planned { mesh, plan, points, .. } = planned;
    let mut distance = Distance::default();
    let steps = 3;
    for (number, leaf) in (0..).zip(&plan.leaves) {
        let root = plan.roots[leaf.root as usize];
        let sub = if root.level == 0 { -1 } else { root.part as i32 };
        let side = f64::from(1 << (leaf.level - root.level));
        for i in 0..=steps {
            for j in 0..=steps {
                let (s, t) = (f64::from(i) / f64::from(steps), f64::from(j) / f64::from(steps));
                let ours = plan.evaluate_leaf(number, s, t, points);
                let (u, v) = ((f64::from(leaf.u) + s) / side, (f64::from(leaf.v) + t) / side);
                let theirs = surface.evaluate(leaf.face, sub, u, v);
                let error = (ours.position - theirs.position).length() / mesh.diagonal();
                if leaf.kind == LeafKind::Cap {
                    distance.caps = distance.caps.max(error);
                    let lift = (ours.position - theirs.position).dot(theirs.normal).abs() / mesh.diagonal();
                    distance.lift = distance.lift.max(lift);
                    continue;
                }
                distance.exact = distance.exact.max(error);
                // Where a corner is no limit of derivatives, the limit surface has a convention for them.
                if (1..steps).contains(&i) && (1..steps).contains(&j) {
                    let length = theirs.du.length().max(theirs.dv.length());
                    let slope = (side * ours.du - theirs.du).length().max((side * ours.dv - theirs.dv).length());
                    distance.slope = distance.slope.max(slope / length);
                }
            }
        }
    }
    distance
}

/// How far a plan is from the limit surface at points that do not depend on the depth, over the diagonal.
pub(crate) fn distance_at_samples(planned: &Planned, surface: &LimitSurface) -> f64 {
    let Planned { mesh, plan, points, .. } = planned;
    let mut distance = 0.0f64;
    for (number, root) in (0..).zip(&plan.roots) {
        let sub = if root.level == 0 { -1 } else { root.part as i32 };
        for (i, j) in (0..=7).flat_map(|i| (0..=7).map(move |j| (i, j))) {
            let (u, v) = (f64::from(i) / 7.0, f64::from(j) / 7.0);
            let error = plan.evaluate(number, u, v, points).position - surface.evaluate(root.face, sub, u, v).position;
            distance = distance.max(error.length() / mesh.diagonal());
        }
    }
    distance
}

#[test]
fn built_in_shapes_come_to_their_limit() {
    for info in ash_subdiv::shapes() {
        let mesh = shape(info.name).unwrap();
        let surface = LimitSurface::new(&mesh).unwrap();
        let mut before = [f64::INFINITY; 3];
        for depth in [0, 1, 3, 5] {
            let planned = Planned::at_depth(&mesh, depth);
            let Distance { exact, slope, caps, lift } = distance(&planned, &surface);
            let samples = distance_at_samples(&planned, &surface);
            println!(
                "{:16} depth {depth}: {exact:8.1e} {slope:8.1e} caps {caps:8.1e} {lift:8.1e} samples {samples:8.1e}",
                info.name
            );
            assert!(exact < 1e-12 && slope < 1e-9, "{} at depth {depth}: {exact:e} {slope:e}", info.name);
            let now = [caps, lift, samples];
            let falls = now.iter().zip(before).all(|(&now, before)| now < 1.001 * before || now < 1e-12);
            assert!(falls, "{} at depth {depth}: {now:?} after {before:?}", info.name);
            before = now;
        }
        assert!(before[2] < 1e-5, "{}: {before:?}", info.name);
    }
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn leaves_are_as_many_as_published() {
    for (name, totals) in
        [("monsterfrog", [1292, 3584, 6896, 10208, 13520]), ("bigguy", [1450, 3226, 5554, 7882, 10210])]
    {
        let mesh = shared_mesh(name);
        let topology = Topology::new(&mesh);
        for (depth, total) in (0..).zip(totals) {
            let options = AdaptiveOptions { depth, ..AdaptiveOptions::default() };
            let plan = Plan::new(&topology, Scheme::Gregory, &options).unwrap();
            println!("{name} at depth {depth}: {} leaves", plan.leaves.len());
            assert_eq!(plan.leaves.len(), total, "{name} at depth {depth}");
        }
    }
}

#[test]
fn trees_lead_to_every_leaf_once() {
    let mesh = shape("polygons").unwrap();
    for scheme in [Scheme::Gregory, Scheme::GregoryFitted] {
        let planned = Planned::new(&mesh, scheme, &AdaptiveOptions { depth: 3, ..AdaptiveOptions::default() });
        let plan = &planned.plan;
        let leaves = plan.nodes.iter().filter(|&node| node & LEAF != 0);
        assert_eq!(leaves.count(), plan.leaves.len());
        for (number, leaf) in (0..).zip(&plan.leaves) {
            let side = f64::from(1 << (leaf.level - plan.roots[leaf.root as usize].level));
            let (u, v) = ((f64::from(leaf.u) + 0.5) / side, (f64::from(leaf.v) + 0.5) / side);
            assert_eq!(plan.locate(leaf.root, u, v), (number, 0.5, 0.5));
        }
    }
}
