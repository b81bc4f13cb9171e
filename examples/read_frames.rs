//! Reads the frames of a run, and prints how high its particles are in the mean, and how fast the fastest is.
//!
//! `cargo run --release --example read_frames -- out`, after `cograin run SCENE -o out` of a scene with a `frame_interval`.
#![allow(clippy::print_stdout, reason = "an example prints what it finds")]

use std::error::Error;
use std::path::{Path, PathBuf};
use vtkio::model::{Attribute, DataSet, Piece};
use vtkio::{IOBuffer, Vtk};

/// Points and velocities of a frame, three numbers each.
fn read(frame: &Path) -> Result<[Vec<f64>; 2], Box<dyn Error>> {
    let DataSet::UnstructuredGrid { pieces, .. } = Vtk::parse_xml(&std::fs::read(frame)?[..])?.data else {
        return Err("expected an unstructured grid".into());
    };
    let [Piece::Inline(piece)] = &pieces[..] else { return Err("expected one piece".into()) };
    let velocities = piece.data.point.iter().find_map(|attribute| match attribute {
        Attribute::DataArray(array) if array.name == "velocity" => Some(&array.data),
        _ => None,
    });
    let numbers = |buffer: &IOBuffer| buffer.cast_into::<f64>().ok_or("expected numbers");
    Ok([numbers(&piece.points)?, numbers(velocities.ok_or("expected velocities")?)?])
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("expected the folder of a run")?;
    let mut frames: Vec<PathBuf> =
        std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    let is_frame = |name: &str| name.starts_with("particles_") && name.ends_with(".vtu");
    frames.retain(|path| path.file_name().is_some_and(|name| is_frame(&name.to_string_lossy())));
    frames.sort();
    for frame in frames {
        let [points, velocities] = read(&frame)?;
        let heights = points.iter().skip(2).step_by(3);
        let height = heights.sum::<f64>() / (points.len() / 3).max(1) as f64;
        let speed = velocities.chunks(3).map(|v| v.iter().map(|part| part * part).sum::<f64>().sqrt());
        println!("{}: mean height {height:.4e} m, at most {:.3e} m/s", frame.display(), speed.fold(0.0, f64::max));
    }
    Ok(())
}
