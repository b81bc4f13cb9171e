//! The ends of interactions, body by body: each body adds up what its own bring, in their order, whichever thread does.

use super::network::UNMOVED;

/// The ends of interactions, body by body.
#[derive(Default)]
pub(super) struct Ends {
    /// First end of each body, and behind the last one their number.
    starts: Vec<u32>,
    /// Ends: twice the interaction, and 1 more for its second end.
    ends: Vec<u32>,
}

impl Ends {
    /// Those of so many bodies, by the bodies at the ends of each interaction; [`UNMOVED`] has none.
    pub(super) fn of(bodies: usize, ends_of: &[[u32; 2]]) -> Self {
        let mut starts = vec![0_u32; bodies + 1];
        for end in ends_of.iter().flatten().filter(|end| **end != UNMOVED) {
            starts[*end as usize + 1] += 1;
        }
        for body in 0..bodies {
            starts[body + 1] += starts[body];
        }
        let mut next = starts.clone();
        let mut ends = vec![0; starts[bodies] as usize];
        for (place, of_element) in ends_of.iter().enumerate() {
            for (end, &body) in of_element.iter().enumerate().filter(|(_, body)| **body != UNMOVED) {
                ends[next[body as usize] as usize] = 2 * place as u32 + end as u32;
                next[body as usize] += 1;
            }
        }
        Self { starts, ends }
    }

    /// The ends of a body.
    #[inline]
    pub(super) fn of_body(&self, body: usize) -> &[u32] {
        &self.ends[self.starts[body] as usize..self.starts[body + 1] as usize]
    }

    /// The same as interactions, each with the end at which the body is.
    #[inline]
    pub(super) fn each_of(&self, body: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.of_body(body).iter().map(|&end| ((end / 2) as usize, (end % 2) as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_has_its_ends_in_the_order_of_the_interactions() {
        let ends = Ends::of(3, &[[1, 0], [1, UNMOVED], [0, 1], [UNMOVED, 2]]);
        let of = |body: usize| ends.each_of(body).collect::<Vec<_>>();
        assert_eq!([of(0), of(1), of(2)], [vec![(0, 1), (2, 0)], vec![(0, 0), (1, 0), (2, 1)], vec![(3, 1)]]);
    }
}
