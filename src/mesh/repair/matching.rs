//! Matchings of many pairs and little cost, from one that is good here and there: augmenting paths.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A partner that a node can have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub node: u32,
    pub cost: f64,
    /// Of the caller.
    pub pair: u32,
}

/// Nodes that a search for a path looks at, at most: time grows with the number of nodes alone. Free nodes that are farther apart stay.
const REACH: usize = 2000;

/// A path from a free node: it ends in `node`, which was parted from its partner.
#[derive(Clone, Copy)]
struct End {
    cost: f64,
    node: u32,
}

/// Partners of nodes.
pub(super) struct Matching<'c> {
    candidates: &'c [Vec<Candidate>],
    /// What each node is matched with.
    pub mates: Vec<Option<Candidate>>,
    /// The search that a node was last seen in, as one that is taken or given away, and how it was come by: the node before, and the
    /// candidate of that.
    seen: Vec<u32>,
    from: Vec<Option<(u32, Candidate)>>,
    search: u32,
}

impl<'c> Matching<'c> {
    pub(super) fn new(candidates: &'c [Vec<Candidate>]) -> Self {
        let count = candidates.len();
        Self { candidates, mates: vec![None; count], seen: vec![0; count], from: vec![None; count], search: 0 }
    }

    /// Matches two nodes.
    pub(super) fn join(&mut self, node: u32, candidate: Candidate) {
        self.mates[node as usize] = Some(candidate);
        self.mates[candidate.node as usize] = Some(Candidate { node, ..candidate });
    }

    /// Finds partners for free nodes, by parting others and finding those new ones, as long as any is found.
    pub(super) fn augment(&mut self) {
        // Late passes find little, and each may be as long as the first.
        loop {
            let free: Vec<u32> =
                (0..).zip(&self.mates).filter(|(_, mate)| mate.is_none()).map(|(node, _)| node).collect();
            let count = free.len();
            let found =
                free.into_iter().filter(|&node| self.mates[node as usize].is_none() && self.augment_from(node)).count();
            if found * 100 <= count {
                return;
            }
        }
    }

    /// Looks for a cheap path from a free node to another, and changes partners along it.
    fn augment_from(&mut self, start: u32) -> bool {
        self.search += 1;
        self.seen[start as usize] = self.search;
        self.from[start as usize] = None;
        let mut ends = BinaryHeap::from([End { cost: 0.0, node: start }]);
        let mut reached = 0;
        while let Some(End { cost, node }) = ends.pop() {
            for candidate in &self.candidates[node as usize] {
                let taken = candidate.node as usize;
                if self.seen[taken] == self.search {
                    continue;
                }
                let Some(mate) = self.mates[taken] else {
                    self.change(node, *candidate);
                    return true;
                };
                self.seen[taken] = self.search;
                if self.seen[mate.node as usize] == self.search {
                    continue;
                }
                self.seen[mate.node as usize] = self.search;
                self.from[mate.node as usize] = Some((node, *candidate));
                ends.push(End { cost: cost + candidate.cost - mate.cost, node: mate.node });
                reached += 1;
            }
            if reached > REACH {
                return false;
            }
        }
        false
    }

    /// Joins the last nodes of a path, and those before them, back to its start.
    fn change(&mut self, node: u32, candidate: Candidate) {
        let mut step = Some((node, candidate));
        while let Some((node, candidate)) = step {
            step = self.from[node as usize];
            self.join(node, candidate);
        }
    }
}

impl Ord for End {
    /// The cheapest is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for End {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for End {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for End {}

#[cfg(test)]
mod tests {
    use super::*;

    /// The most pairs there can be, by trying all.
    fn most(candidates: &[Vec<Candidate>], free: &mut [bool]) -> usize {
        let Some(node) = free.iter().position(|&free| free) else { return 0 };
        free[node] = false;
        let mut best = most(candidates, free);
        for candidate in &candidates[node] {
            if free[candidate.node as usize] {
                free[candidate.node as usize] = false;
                best = best.max(1 + most(candidates, free));
                free[candidate.node as usize] = true;
            }
        }
        free[node] = true;
        best
    }

    #[test]
    fn paths_of_any_length_are_found() {
        // A path of twelve nodes, of which the inner ones are matched so that the ends are left.
        let mut candidates = vec![Vec::new(); 12];
        for node in 0..11u32 {
            candidates[node as usize].push(Candidate { node: node + 1, cost: 1.0, pair: node });
            candidates[node as usize + 1].push(Candidate { node, cost: 1.0, pair: node });
        }
        let mut matching = Matching::new(&candidates);
        for node in [1, 3, 5, 7, 9] {
            matching.join(node, Candidate { node: node + 1, cost: 1.0, pair: node });
        }
        matching.augment();
        let pairs: Vec<u32> = matching.mates.iter().map(|mate| mate.expect("a partner").pair).collect();
        assert_eq!(pairs, [0, 0, 2, 2, 4, 4, 6, 6, 8, 8, 10, 10]);
    }

    #[test]
    fn matchings_go_both_ways_and_leave_few_free() {
        let (mut state, mut found, mut possible) = (88172645463325252u64, 0, 0);
        for _ in 0..300 {
            let mut candidates = vec![Vec::new(); 10];
            for pair in 0..14 {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                let (a, b) = (state as u32 % 10, (state >> 32) as u32 % 10);
                if a != b {
                    candidates[a as usize].push(Candidate { node: b, cost: 1.0, pair });
                    candidates[b as usize].push(Candidate { node: a, cost: 1.0, pair });
                }
            }
            let mut matching = Matching::new(&candidates);
            matching.augment();
            for (node, mate) in (0..).zip(&matching.mates) {
                let Some(mate) = mate else { continue };
                assert_eq!(
                    matching.mates[mate.node as usize].map(|back| (back.node, back.pair)),
                    Some((node, mate.pair))
                );
            }
            found += matching.mates.iter().flatten().count() / 2;
            possible += most(&candidates, &mut [true; 10]);
        }
        // Odd circles are not looked through, so that some are missed.
        assert!(found * 100 >= possible * 97 && found <= possible, "{found} of {possible}");
    }
}
