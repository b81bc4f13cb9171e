//! Boxes around triangles, and boxes around these: what is near a place without a look at every triangle.

use crate::base::number::Vector;

/// Triangles in a leaf, at most.
const LEAF: usize = 4;

/// A box and what is in it.
#[derive(Clone, Debug)]
struct Node {
    /// Lower corner \[m\].
    low: [f64; 3],
    /// Upper corner \[m\].
    high: [f64; 3],
    /// Where the triangles of a leaf begin and end in the order; of other nodes, the two nodes below.
    below: [u32; 2],
    /// Whether it is a leaf.
    leaf: bool,
}

/// A tree of boxes.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    /// The nodes, the first one around all others.
    nodes: Vec<Node>,
    /// The triangles, leaf by leaf.
    order: Vec<u32>,
}

impl Tree {
    /// Around these boxes, lower and upper corner of each.
    pub(super) fn of(boxes: &[[[f64; 3]; 2]]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len() as u32).collect() };
        if !boxes.is_empty() {
            tree.build(boxes, 0, boxes.len());
        }
        tree
    }

    /// Makes the node of a part of the order. Returns its place.
    fn build(&mut self, boxes: &[[[f64; 3]; 2]], from: usize, to: usize) -> u32 {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &triangle in &self.order[from..to] {
            let [lower, upper] = boxes[triangle as usize];
            for axis in 0..3 {
                low[axis] = low[axis].min(lower[axis]);
                high[axis] = high[axis].max(upper[axis]);
            }
        }
        let (place, leaf) = (self.nodes.len(), to - from <= LEAF);
        self.nodes.push(Node { low, high, below: [from as u32, to as u32], leaf });
        if !leaf {
            let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
            let axis = if size[0] >= size[1] && size[0] >= size[2] { 0 } else { 1 + usize::from(size[2] > size[1]) };
            let middle = |triangle: &u32| boxes[*triangle as usize].iter().map(|corner| corner[axis]).sum::<f64>();
            self.order[from..to].sort_unstable_by(|a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
            let half = (from + to) / 2;
            let below = [self.build(boxes, from, half), self.build(boxes, half, to)];
            self.nodes[place].below = below;
        }
        place as u32
    }

    /// Hands out the triangles whose leaf is within reach of a centre \[m\].
    pub(super) fn near(&self, centre: Vector, reach: f64, mut hand: impl FnMut(u32)) {
        self.search(centre, reach, |triangle| {
            hand(triangle);
            reach
        });
    }

    /// The same, the nearer half of each box first; who is handed a triangle says how far the search still reaches \[m\].
    pub(super) fn search(&self, centre: Vector, mut reach: f64, mut hand: impl FnMut(u32) -> f64) {
        let centre = centre.to_array();
        let apart = |place: u32| {
            let node = &self.nodes[place as usize];
            let along = |axis: usize| (node.low[axis] - centre[axis]).max(centre[axis] - node.high[axis]).max(0.0);
            along(0) * along(0) + along(1) * along(1) + along(2) * along(2)
        };
        let mut waiting = [(0_u32, 0.0); 64];
        let mut count = usize::from(!self.nodes.is_empty());
        if count > 0 {
            waiting[0].1 = apart(0);
        }
        while count > 0 {
            count -= 1;
            let (place, away) = waiting[count];
            if away > reach * reach {
                continue;
            }
            let node = &self.nodes[place as usize];
            let [first, second] = node.below;
            if node.leaf {
                self.order[first as usize..second as usize].iter().for_each(|triangle| reach = hand(*triangle));
            } else {
                // Halves of at most 2³² triangles: the way down is never longer than the room.
                let [one, other] = [first, second].map(|place| (place, apart(place)));
                let [farther, nearer] = if one.1 > other.1 { [one, other] } else { [other, one] };
                waiting[count] = farther;
                waiting[count + 1] = nearer;
                count += 2;
            }
        }
    }
}
