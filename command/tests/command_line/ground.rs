//! What the tests of the command line stand on: scenes, places, the command itself.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A few spheres that fall into a box without a lid. `RUN` and `OUTPUT` stand for the rest of those tables.
pub(crate) const SCENE: &str = r#"
gravity = [0.3, 0.0, -9.81]

[run]
RUN

[material.glass]
density = 2500.0
youngs_modulus = 1.0e7
poissons_ratio = 0.25

[pair.glass.glass]
restitution = 0.6
friction = 0.4

[contact.touch.normal.hertz]
[contact.touch.tangential.history]

[particles.few]
material = "glass"
list = [
    { position = [0.000, 0.000, 0.012], radius = 0.005 },
    { position = [0.011, 0.001, 0.012], radius = 0.005, angular_velocity = [0.0, 50.0, 0.0] },
    { position = [0.004, 0.009, 0.013], radius = 0.004 },
    { position = [0.005, 0.003, 0.024], radius = 0.005, velocity = [0.0, 0.1, -0.5] },
    { position = [0.002, 0.004, 0.036], radius = 0.006 },
]

[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"

[boundary.x_low]
plane = { point = [-0.02, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "glass"

[boundary.x_high]
plane = { point = [0.03, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }
material = "glass"

[output]
OUTPUT
"#;

/// Outputs of every kind.
pub(crate) const ALL_OUTPUTS: &str =
    "history_interval = 2e-3\nframe_interval = 2e-2\ncontacts = true\nenergy = true\ncheckpoint_interval = 1e-2";

/// A folder of one test, empty at its start.
pub(crate) struct Place(pub(crate) PathBuf);

impl Place {
    /// The folder of the test with this name.
    pub(crate) fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("command_line_{name}"));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// A scene with these lines in `[run]` and `[output]`.
    pub(crate) fn scene(&self, run: &str, output: &str) -> PathBuf {
        let path = self.0.join("scene.toml");
        fs::write(&path, SCENE.replace("RUN", run).replace("OUTPUT", output)).unwrap();
        path
    }

    /// A path in it.
    pub(crate) fn at(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

/// The command, with arguments.
pub(crate) fn cograin(arguments: &[&dyn AsRef<std::ffi::OsStr>]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cograin"));
    command.args(arguments.iter().copied().map(AsRef::as_ref)).stdin(Stdio::null());
    command
}

/// What it says on the standard error, having ended with this status.
pub(crate) fn complaint(output: &Output, status: i32) -> String {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(status), "{said}{}", String::from_utf8_lossy(&output.stdout));
    said
}

/// Every file of a folder but the summary, which tells of one session. Folders inside are passed over.
pub(crate) fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap).filter(|entry| entry.path().is_file());
    let named = entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()));
    named.filter(|(name, _)| name != "summary.json").collect()
}

/// Says which files differ.
pub(crate) fn assert_same(one: &Path, other: &Path) {
    let (one, other) = (results(one), results(other));
    assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>());
    let differing: Vec<_> = one.iter().filter(|(name, bytes)| other[*name] != **bytes).map(|(name, _)| name).collect();
    assert!(differing.is_empty(), "these files differ: {differing:?}");
}

/// Waits until the history has some rows, while the run goes on.
pub(crate) fn wait_for_rows(child: &mut Child, folder: &Path, rows: usize) {
    let begun = Instant::now();
    loop {
        let text = fs::read_to_string(folder.join("history.csv")).unwrap_or_default();
        if text.lines().count() > rows {
            break;
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "the run does not come forward");
        assert!(child.try_wait().unwrap().is_none(), "the run ended before it could be stopped");
        sleep(Duration::from_millis(2));
    }
    assert!(child.try_wait().unwrap().is_none(), "the run ended before it could be stopped");
}

/// A value in `summary.json`.
pub(crate) fn summary(folder: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap()
}

/// A column of `history.csv`.
pub(crate) fn column(folder: &Path, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("history.csv")).unwrap();
    let mut lines = text.lines();
    let place = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect()
}
