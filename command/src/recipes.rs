//! `cograin new`: scenes to start from.

use super::{Ending, say};
use clap::Args;
use clap::builder::PossibleValuesParser;
use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A scene to start from.
struct Recipe {
    /// Its name.
    name: &'static str,
    /// One line about it.
    about: &'static str,
    /// Its files: name and text. The first is the scene.
    files: &'static [(&'static str, &'static str)],
}

/// Declares the table: name, what it is, and its files, each with the place where this program has it.
macro_rules! recipes {
    ($($name:literal $about:literal: $($file:literal $place:literal),+;)+) => {
        /// All recipes.
        const RECIPES: &[Recipe] =
            &[$(Recipe { name: $name, about: $about, files: &[$(($file, include_str!($place))),+] }),+];
        /// Their names.
        const NAMES: &[&str] = &[$($name),+];
    };
}

recipes! {
    "drop" "a marble on a table that an outside program lifts":
        "scene.toml" "../recipes/drop/scene.toml",
        "couple.py" "../recipes/drop/couple.py";
    "oedometer" "grains in a box, pressed by a lid":
        "scene.toml" "../recipes/oedometer/scene.toml",
        "press.csv" "../recipes/oedometer/press.csv",
        "couple.py" "../recipes/oedometer/couple.py";
    "triaxial" "a cube of sand between six servos":
        "scene.toml" "../../models/triaxial/scene.toml",
        "input.csv" "../../models/triaxial/input.csv";
    "element_test" "sand in a cell that repeats: compression, triaxial test, simple shear":
        "scene.toml" "../recipes/element_test/scene.toml",
        "couple.py" "../recipes/element_test/couple.py";
    "silo" "a hopper with a gate; grains are fed in and run out":
        "scene.toml" "../../models/hopper/scene.toml",
        "couple.py" "../recipes/silo/couple.py";
    "drum" "a drum that a motor turns":
        "scene.toml" "../../models/drum/scene.toml",
        "couple.py" "../recipes/drum/couple.py";
    "beam" "a bonded beam, clamped and pushed":
        "scene.toml" "../../models/cantilever/scene.toml",
        "couple.py" "../recipes/beam/couple.py";
    "rock_core" "a bonded core that a press breaks":
        "scene.toml" "../../models/rock_core/scene.toml",
        "couple.py" "../recipes/rock_core/couple.py";
    "plate" "grains on an elastic skin, node by node":
        "scene.toml" "../../models/plate/scene.toml",
        "coarse.obj" "../../models/plate/coarse.obj",
        "couple.py" "../recipes/plate/couple.py";
    "loaded_beam" "grains on a floor that an elastic beam carries":
        "scene.toml" "../recipes/loaded_beam/scene.toml",
        "couple.py" "../recipes/loaded_beam/couple.py";
    "fluid" "grains that settle in water":
        "scene.toml" "../recipes/fluid/scene.toml";
    "fluidised_column" "a bed of beads that air lifts, its flow a partner":
        "scene.toml" "../../models/fluidised_column/scene.toml",
        "couple.py" "../recipes/fluidised_column/couple.py";
    "heat" "grains that fall on a plate which warms them":
        "scene.toml" "../recipes/heat/scene.toml",
        "couple.py" "../recipes/heat/couple.py";
    "clumps" "ballast: stones of four spheres fall into a box":
        "scene.toml" "../recipes/clumps/scene.toml";
    "tablets" "tablets of seven spheres in a drum that turns":
        "scene.toml" "../recipes/tablets/scene.toml";
    "mill" "a ball mill: impacts by energy, wear of drum and lifters":
        "scene.toml" "../recipes/mill/scene.toml";
    "screw" "a screw in its trough takes grains along: meshes, parts of one machine":
        "scene.toml" "../recipes/screw/scene.toml",
        "flight.obj" "../recipes/screw/flight.obj",
        "trough.obj" "../recipes/screw/trough.obj";
    "shear_cell" "a powder that sticks (jkr), sheared under two normal stresses":
        "scene.toml" "../recipes/shear_cell/scene.toml",
        "shear.csv" "../recipes/shear_cell/shear.csv";
    "calibration" "friction of grains from a heap and an oedometer curve, with their uncertainty":
        "oedometer.toml" "../../models/calibration/oedometer.toml",
        "press.csv" "../../models/calibration/press.csv",
        "heap.toml" "../../models/calibration/heap.toml",
        "measured.csv" "../../models/calibration/measured.csv",
        "calibrate.py" "../../models/calibration/calibrate.py";
}

/// `cograin new`
#[derive(Args)]
pub(super) struct NewArguments {
    /// What to start from; `--list` tells what there is
    #[arg(value_name = "RECIPE", value_parser = PossibleValuesParser::new(NAMES), hide_possible_values = true, required_unless_present = "list")]
    recipe: Option<String>,
    /// Folder of the files; by default one with the name of the recipe
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// List what there is
    #[arg(long)]
    list: bool,
}

/// `cograin new`
pub(super) fn new(arguments: &NewArguments) -> Result<(), Ending> {
    let wanted = RECIPES.iter().find(|recipe| arguments.recipe.as_deref() == Some(recipe.name));
    let Some(recipe) = wanted.filter(|_| !arguments.list) else {
        return RECIPES.iter().try_for_each(|recipe| say(format_args!("{:<12} {}", recipe.name, recipe.about)));
    };
    let folder = arguments.output.clone().unwrap_or_else(|| PathBuf::from(recipe.name));
    let there = recipe.files.iter().map(|(name, _)| folder.join(name)).find(|path| path.symlink_metadata().is_ok());
    if let Some(path) = there {
        return Err(Ending::refused(format_args!(
            "{}: expected no such file, found one; take another folder",
            path.display()
        )));
    }
    if folder.metadata().is_ok_and(|it| !it.is_dir()) {
        return Err(Ending::refused(format_args!(
            "{}: expected a folder, or a name that is not there yet, found a file",
            folder.display()
        )));
    }
    fs::create_dir_all(&folder).map_err(|error| Ending::failed(format_args!("{}: {error}", folder.display())))?;
    for (name, text) in recipe.files {
        write(&folder.join(name), text)?;
    }
    let has = |end: &str| recipe.files.iter().find(|(name, _)| name.ends_with(end)).map(|(name, _)| folder.join(name));
    let (scene, out) = (folder.join(recipe.files[0].0), folder.join("out"));
    let inputs = has(".csv").map_or(String::new(), |table| format!(" --inputs {}", table.display()));
    say(format_args!("{}: {}", folder.display(), recipe.about))?;
    say(format_args!("next: cograin check {}", scene.display()))?;
    say(format_args!("      cograin run {} -o {}{inputs}", scene.display(), out.display()))?;
    let script = recipe.files.iter().find(|(name, _)| name.ends_with(".py"));
    script.map_or(Ok(()), |(name, _)| say(format_args!("      cd {} && python {name}", folder.display())))
}

/// Writes a file that is not there.
fn write(path: &Path, text: &str) -> Result<(), Ending> {
    let written = File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Ending::refused(format_args!("{}: {error}", path.display())),
        _ => Ending::failed(format_args!("{}: {error}", path.display())),
    })
}
