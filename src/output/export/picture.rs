//! `model.png`: the particles and boundaries at the beginning, from the front, the right and above.

use crate::base::number::Vector;
use crate::engine::state::State;
use crate::output::results::boundaries::boundaries;
use crate::output::results::vtk::{Kind, PointCloud};
use crate::scene::Scene;

/// Width and greatest height of the picture, in pixels.
const SIZE: usize = 512;

/// Every pixel is the mean of this square.
const FINER: usize = 2;

/// Part of the picture's width that stays empty on each side.
const MARGIN: f64 = 0.03;

/// Share of its own colour that a boundary gives to what is behind it.
const COVER: f64 = 0.22;

/// To the right of the picture, to its top and to the viewer: unit vectors, 30° about z and 20° from above.
const VIEW: [[f64; 3]; 3] = [
    [0.866_025_403_784_438_6, 0.5, 0.0],
    [-0.171_010_071_662_834_34, 0.296_198_132_726_023_7, 0.939_692_620_785_908_4],
    [0.469_846_310_392_954_2, -0.813_797_681_349_373_7, 0.342_020_143_325_668_7],
];

/// Where the light comes from, in the axes of the view.
const LIGHT: [f64; 3] = [-0.4, 0.6, 0.692_820_323_027_550_9];

/// Colours of the sets of particles, told apart with any colour vision.
const COLOURS: [[f64; 3]; 7] = [
    [230.0, 159.0, 0.0],
    [86.0, 180.0, 233.0],
    [0.0, 158.0, 115.0],
    [204.0, 121.0, 167.0],
    [213.0, 94.0, 0.0],
    [0.0, 114.0, 178.0],
    [240.0, 228.0, 66.0],
];

/// Colour of boundaries.
const BOUNDARY: [f64; 3] = [96.0, 104.0, 112.0];

/// The picture as a PNG file; none of a scene in which nothing is to be seen.
pub(super) fn png(scene: &Scene, state: &State) -> Option<Vec<u8>> {
    let seen = |point: [f64; 3]| VIEW.map(|axis| Vector::from(axis).dot(point.into()));
    let spheres: Vec<Sphere> = (state.particles.slots())
        .map(|slot| {
            let ([x, y, z, radius], id) = (state.particles.position[slot], state.particles.id[slot]);
            let set = scene.particles.get(id as usize).map_or(0, |particle| particle.set.index());
            Sphere { centre: seen([x, y, z]), radius, colour: COLOURS[set % COLOURS.len()] }
        })
        .collect();
    let shown = boundaries(scene, &state.particles, (&state.boundaries, &state.nodes), (&[], &[]), None);
    let points: Vec<[f64; 3]> =
        shown.points.chunks_exact(3).map(|point| seen([point[0], point[1], point[2]])).collect();

    let mut frame = Frame::around(&spheres, &points)?;
    spheres.iter().for_each(|sphere| frame.sphere(sphere));
    for corners in triangles(&shown) {
        frame.triangle(corners.map(|corner| points[corner as usize]));
    }
    frame.encode()
}

/// The facets of the boundaries, each as triangles.
fn triangles(shown: &PointCloud) -> impl Iterator<Item = [u32; 3]> + '_ {
    let (corners, ends): (&[u32], &[u32]) = match &shown.kind {
        Kind::Facets { corners, ends } => (corners, ends),
        Kind::Points | Kind::Lines => (&[], &[]),
    };
    let starts = std::iter::once(0).chain(ends.iter().copied());
    starts.zip(ends).flat_map(|(start, end)| {
        let facet = &corners[start as usize..*end as usize];
        (2..facet.len()).map(|last| [facet[0], facet[last - 1], facet[last]])
    })
}

/// A particle in the axes of the view \[m\].
struct Sphere {
    /// Centre.
    centre: [f64; 3],
    /// Radius.
    radius: f64,
    /// Colour.
    colour: [f64; 3],
}

/// The picture while it is drawn.
struct Frame {
    /// Width and height.
    size: [usize; 2],
    /// What is seen at the middle \[m\].
    middle: [f64; 2],
    /// Pixels in a metre.
    scale: f64,
    /// Colours, row after row from the top.
    colours: Vec<[f64; 3]>,
    /// How near the particle is that is seen there \[m\].
    nearness: Vec<f64>,
}

impl Frame {
    /// An empty picture of a size that all of this fits into.
    fn around(spheres: &[Sphere], points: &[[f64; 3]]) -> Option<Self> {
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut reach = |point: &[f64; 3], radius: f64| {
            for (end, at) in ends.iter_mut().zip(point) {
                *end = [end[0].min(at - radius), end[1].max(at + radius)];
            }
        };
        spheres.iter().for_each(|sphere| reach(&sphere.centre, sphere.radius));
        points.iter().for_each(|point| reach(point, 0.0));
        let extent = ends.map(|[low, high]| high - low);
        let largest = extent[0].max(extent[1]);
        if !(largest.is_finite() && largest > 0.0) {
            return None;
        }
        let fine = (SIZE * FINER) as f64;
        let scale = fine * (1.0 - 2.0 * MARGIN) / largest;
        // Whole pixels of the coarse picture, and never a line.
        let size = extent.map(|extent| {
            let pixels = (extent * scale + 2.0 * MARGIN * fine) / FINER as f64;
            (pixels.ceil() as usize).clamp(SIZE / 8, SIZE) * FINER
        });
        let count = size[0] * size[1];
        Some(Self {
            size,
            middle: ends.map(|[low, high]| 0.5 * (low + high)),
            scale,
            colours: vec![[255.0; 3]; count],
            nearness: vec![f64::NEG_INFINITY; count],
        })
    }

    /// Where a point is seen, in pixels from the left and from the top.
    fn place(&self, point: &[f64; 3]) -> [f64; 2] {
        let [width, height] = self.size.map(|size| size as f64);
        [
            0.5 * width + (point[0] - self.middle[0]) * self.scale,
            0.5 * height - (point[1] - self.middle[1]) * self.scale,
        ]
    }

    /// The pixels whose middles are between two places along an axis.
    fn between(&self, axis: usize, [low, high]: [f64; 2]) -> std::ops::Range<usize> {
        let bound = |place: f64| (place - 0.5).ceil().clamp(0.0, self.size[axis] as f64) as usize;
        bound(low)..bound(high)
    }

    /// Draws a particle. One that is smaller than a pixel still gets one.
    fn sphere(&mut self, sphere: &Sphere) {
        let ([x, y], radius) = (self.place(&sphere.centre), (sphere.radius * self.scale).max(0.75));
        for row in self.between(1, [y - radius, y + radius]) {
            for column in self.between(0, [x - radius, x + radius]) {
                let across = [(column as f64 + 0.5 - x) / radius, (y - row as f64 - 0.5) / radius];
                let square = 1.0 - across[0] * across[0] - across[1] * across[1];
                if square <= 0.0 {
                    continue;
                }
                let normal = [across[0], across[1], square.sqrt()];
                let nearness = sphere.centre[2] + normal[2] * sphere.radius;
                let place = row * self.size[0] + column;
                if nearness > self.nearness[place] {
                    let lit: f64 = normal.iter().zip(&LIGHT).map(|(normal, light)| normal * light).sum();
                    let share = 0.45 + 0.55 * lit.max(0.0);
                    self.nearness[place] = nearness;
                    self.colours[place] = sphere.colour.map(|part| part * share);
                }
            }
        }
    }

    /// Draws a triangle of a boundary: a veil over what is behind it.
    fn triangle(&mut self, corners: [[f64; 3]; 3]) {
        let places = corners.map(|corner| self.place(&corner));
        let edge =
            |a: [f64; 2], b: [f64; 2], p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        let area = edge(places[0], places[1], places[2]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let range = |axis: usize| {
            let along = places.map(|place| place[axis]);
            [
                along.iter().copied().fold(f64::INFINITY, f64::min),
                along.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        for row in self.between(1, range(1)) {
            for column in self.between(0, range(0)) {
                let point = [column as f64 + 0.5, row as f64 + 0.5];
                let shares = [1, 2, 0].map(|first: usize| edge(places[first], places[(first + 1) % 3], point) / area);
                if shares.iter().any(|share| *share < 0.0) {
                    continue;
                }
                let nearness: f64 = shares.iter().zip(&corners).map(|(share, corner)| share * corner[2]).sum();
                let place = row * self.size[0] + column;
                if nearness > self.nearness[place] {
                    for (part, own) in self.colours[place].iter_mut().zip(BOUNDARY) {
                        *part += COVER * (own - *part);
                    }
                }
            }
        }
    }

    /// The file.
    fn encode(&self) -> Option<Vec<u8>> {
        let [width, height] = self.size.map(|size| size / FINER);
        let mut pixels = Vec::with_capacity(3 * width * height);
        for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
            for part in 0..3 {
                let finer = (0..FINER * FINER).map(|place| {
                    let [down, right] = [place / FINER, place % FINER];
                    self.colours[(row * FINER + down) * self.size[0] + column * FINER + right][part]
                });
                pixels.push((finer.sum::<f64>() / (FINER * FINER) as f64).round() as u8);
            }
        }
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().ok()?;
        writer.write_image_data(&pixels).ok()?;
        writer.finish().ok()?;
        Some(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colours and size of a picture that is read back.
    fn decoded(bytes: &[u8]) -> (Vec<u8>, [usize; 2]) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        (pixels, [info.width as usize, info.height as usize])
    }

    #[test]
    fn one_sphere_is_a_round_disc_in_the_middle() {
        let sphere = Sphere { centre: [3.0, -2.0, 7.0], radius: 0.5, colour: COLOURS[0] };
        let mut frame = Frame::around(std::slice::from_ref(&sphere), &[]).unwrap();
        frame.sphere(&sphere);
        let (pixels, [width, height]) = decoded(&frame.encode().unwrap());
        assert_eq!([width, height], [SIZE, SIZE]);
        let covered = pixels.chunks_exact(3).filter(|pixel| *pixel != [255; 3]).count() as f64;
        let radius = SIZE as f64 * (0.5 - MARGIN);
        // The rim is a pixel wide.
        let expected = std::f64::consts::PI * radius * radius;
        assert!(
            (covered - expected).abs() < 2.0 * std::f64::consts::PI * radius,
            "{covered} pixels, {expected} expected"
        );
    }

    #[test]
    fn what_is_nearer_hides_what_is_behind_whatever_comes_first() {
        let [near, far] = [1.0, 0.0].map(|away| Sphere {
            centre: [0.0, 0.0, away],
            radius: 0.5,
            colour: if away > 0.0 { COLOURS[1] } else { COLOURS[0] },
        });
        let drawn = |order: [&Sphere; 2]| {
            let mut frame = Frame::around(&[], &[[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]).unwrap();
            order.iter().for_each(|sphere| frame.sphere(sphere));
            frame.encode().unwrap()
        };
        assert_eq!(drawn([&near, &far]), drawn([&far, &near]));
    }

    #[test]
    fn a_triangle_veils_a_particle_only_if_it_stands_before_it() {
        let sphere = Sphere { centre: [0.0; 3], radius: 0.1, colour: COLOURS[0] };
        let middle = |nearness: f64| {
            let corners = [[-1.0, -1.0, nearness], [1.0, -1.0, nearness], [0.0, 1.0, nearness]];
            let mut frame = Frame::around(&[], &corners).unwrap();
            frame.sphere(&sphere);
            let before = frame.colours.clone();
            frame.triangle(corners);
            let middle = frame.size[1] / 2 * frame.size[0] + frame.size[0] / 2;
            (before[middle], frame.colours[middle])
        };
        let (bare, hidden) = middle(-1.0);
        assert_eq!(bare, hidden);
        let (bare, veiled) = middle(1.0);
        assert_ne!(bare, veiled);
    }

    #[test]
    fn nothing_gives_no_picture() {
        assert!(Frame::around(&[], &[]).is_none());
    }
}
