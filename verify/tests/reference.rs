//! Trajectories that other engines left are reproduced, and bad cases are refused with a reason.

use cograin::bond::keys::FormulationChoice;
use cograin_verify::{Options, Report, find, replay};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Where the cases of contacts lie.
const CONTACT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/reference/contact");

/// Where the cases of bonds lie.
const BOND: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/reference/bond");

/// Where the cases of rolling springs, sticky and dented spheres lie.
const MORE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/reference/more");

/// Where the cases of suppressed contacts lie.
const SUPPRESSED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/reference/suppressed");

/// Where the cases of heat lie.
const HEAT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/reference/heat");

/// Where the cases of meshes and cylinders lie.
const MESH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/reference/mesh");

/// A folder of this test's own that goes when it is dropped.
struct Scratch(PathBuf);

impl Scratch {
    /// An empty folder, of which no other test knows.
    fn new(name: &str) -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let (process, number) = (std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(format!("cograin-reference-{process}-{number}-{name}"));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// A case folder with this text as `case.json`.
    fn case(&self, text: &str) -> PathBuf {
        fs::write(self.0.join("case.json"), text).unwrap();
        self.0.clone()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The `case.json` of a case as text.
fn text_of(case: &str) -> String {
    fs::read_to_string(Path::new(CONTACT).join(case).join("case.json")).unwrap()
}

/// That text with one piece replaced, which must be there.
fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from:?} is not in the case");
    text.replacen(from, to, 1)
}

/// The message that refuses this case, without its path.
fn refusal(name: &str, text: &str) -> String {
    let scratch = Scratch::new(name);
    let folder = scratch.case(text);
    let message = replay(&folder, &Options::default()).expect_err("the case is refused").to_string();
    message.replace(&format!("{}/", folder.display()), "")
}

#[test]
fn every_contact_case_holds() {
    let cases = find(&[CONTACT.into()]).unwrap();
    assert_eq!(cases.len(), 42);
    let reports: Vec<_> = cases.iter().map(|case| replay(case, &Options::default()).unwrap()).collect();
    let failed: Vec<String> = reports.iter().filter(|report| !report.passed()).map(ToString::to_string).collect();
    assert!(failed.is_empty(), "\n{}", failed.join("\n"));
}

/// 35 trajectories of other engines, and those of sticky spheres once more with arms R − δ/2.
#[test]
fn every_case_of_rolling_springs_and_of_sticky_and_dented_spheres_holds() {
    let cases = find(&["contact", "contact_own_arms"].map(|folder| Path::new(MORE).join(folder))).unwrap();
    assert_eq!(cases.len(), 35 + 14);
    let reports: Vec<_> = cases.iter().map(|case| replay(case, &Options::default()).unwrap()).collect();
    let failed: Vec<String> = reports.iter().filter(|report| !report.passed()).map(ToString::to_string).collect();
    assert!(failed.is_empty(), "\n{}", failed.join("\n"));
}

/// The lines of those cases of bonds that fail, of the named ones or of all.
fn failing_bonds(options: &Options, chosen: impl Fn(&str) -> bool) -> (usize, Vec<String>) {
    let cases = find(&[BOND.into()]).unwrap();
    let cases = cases.iter().filter(|case| chosen(&case.file_name().unwrap().to_string_lossy()));
    let reports: Vec<Report> = cases.map(|case| replay(case, options).unwrap()).collect();
    let failed = reports.iter().filter(|report| !report.passed()).map(ToString::to_string);
    (reports.len(), failed.collect())
}

#[test]
fn every_bond_case_holds_in_windows_and_from_its_start() {
    for free in [false, true] {
        let (count, failed) = failing_bonds(&Options { free, ..Options::default() }, |_| true);
        assert_eq!(count, 40);
        assert!(failed.is_empty(), "free: {free}\n{}", failed.join("\n"));
    }
}

#[test]
fn bonds_that_do_not_turn_are_the_same_in_every_formulation() {
    let still = [
        "tension",
        "compression",
        "twist",
        "bending",
        "break_distance",
        "break_sigma",
        "break_bending",
        "break_twist",
        "ratio_tension_compression",
    ];
    for formulation in [FormulationChoice::Incremental, FormulationChoice::FiniteRotation] {
        let options = Options { formulation, ..Options::default() };
        let (count, failed) = failing_bonds(&options, |case| still.contains(&case));
        assert_eq!(count, still.len());
        assert!(failed.is_empty(), "{formulation:?}\n{}", failed.join("\n"));
        let (_, failed) = failing_bonds(&options, |case| case == "free_combined");
        assert_eq!(failed.len(), 1, "{formulation:?} repeats the engine's bending");
    }
}

#[test]
fn a_bond_with_another_stiffness_or_strength_fails() {
    let folder = Path::new(BOND).join("break_sigma");
    let whole = fs::read_to_string(folder.join("case.json")).unwrap();
    let case: serde_json::Value = serde_json::from_str(&whole).unwrap();
    for property in ["normalBondStiffnessPerUnitArea", "maxSigmaBond"] {
        let scratch = Scratch::new(property);
        for file in ["samples.csv", "bonds.csv"] {
            fs::copy(folder.join(file), scratch.0.join(file)).unwrap();
        }
        let mut other = case.clone();
        let entry = &mut other["pair_properties"][property][0][0];
        *entry = serde_json::json!(entry.as_f64().unwrap() * 0.5);
        let report = replay(&scratch.case(&other.to_string()), &Options::default()).unwrap();
        assert!(!report.passed(), "{report}");
    }
}

/// Bending that is rounding of the other engine (1e-20 N m) was measured against a torque that is rounding, too (1e-18
/// N m), so that two right runs differed by percents. The scale of a torque that is round-off is force times radius.
#[test]
fn bending_that_is_round_off_is_measured_against_force_times_radius() {
    let folder = Path::new(BOND).join("tension");
    let scratch = Scratch::new("round-off");
    let case = scratch.case(&fs::read_to_string(folder.join("case.json")).unwrap());
    let rounding = |file: &str, columns: &[&str], value: &str| {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        let mut lines = text.lines();
        let header = lines.next().unwrap();
        let places: Vec<usize> =
            columns.iter().map(|column| header.split(',').position(|name| name == *column).unwrap()).collect();
        let mut changed = header.to_owned();
        for line in lines {
            let mut cells: Vec<&str> = line.split(',').collect();
            for &place in &places {
                cells[place] = value;
            }
            changed = format!("{changed}\n{}", cells.join(","));
        }
        fs::write(scratch.0.join(file), changed + "\n").unwrap();
    };
    rounding("samples.csv", &["tx", "ty", "tz"], "1e-18");
    rounding("bonds.csv", &["ttx", "tty", "ttz"], "1e-20");
    let report = replay(&case, &Options { free: true, ..Options::default() }).unwrap();
    assert!(report.passed(), "{report}");
}

#[test]
fn contacts_that_bonds_suppress_are_replayed_and_without_the_flag_are_not() {
    let cases = find(&[SUPPRESSED.into()]).unwrap();
    assert_eq!(cases.len(), 3);
    for case in cases {
        for free in [false, true] {
            let report = replay(&case, &Options { free, ..Options::default() }).unwrap();
            assert!(report.passed(), "free: {free}\n{report}");
        }
        let mut json: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(case.join("case.json")).unwrap()).unwrap();
        json["model"]["disableNormalWhenBonded"] = false.into();
        let scratch = Scratch::new("open");
        for file in ["samples.csv", "bonds.csv"].into_iter().filter(|file| case.join(file).exists()) {
            fs::copy(case.join(file), scratch.0.join(file)).unwrap();
        }
        let report = replay(&scratch.case(&json.to_string()), &Options::default()).unwrap();
        assert!(!report.passed(), "{report}");
    }
}

#[test]
fn every_case_of_a_mesh_or_a_cylinder_holds() {
    let cases = find(&[MESH.into()]).unwrap();
    assert_eq!(cases.len(), 14);
    for case in cases {
        let report = replay(&case, &Options::default()).unwrap();
        assert!(report.passed(), "{report}");
    }
}

#[test]
fn bad_cases_of_bonds_are_refused() {
    let whole = fs::read_to_string(Path::new(BOND).join("tension/case.json")).unwrap();
    let case: serde_json::Value = serde_json::from_str(&whole).unwrap();
    let with = |place: &str, key: &str, value: serde_json::Value| {
        let mut other = case.clone();
        other[place][key] = value;
        other.to_string()
    };
    let table = [
        (
            "heat",
            with("model", "temperatureBreak", true.into()),
            "case.json, model.temperatureBreak: expected false, as in the other engine, found true",
        ),
        (
            "damping",
            with("pair_properties", "dampingNormalForceBond", serde_json::json!([[1.5]])),
            "case.json, pair_properties.dampingNormalForceBond[0][0]: expected a number from 0 to 1, found 1.5",
        ),
        (
            "reach",
            with("pair_properties", "maxDistanceBond", serde_json::json!([])),
            "case.json, pair_properties.maxDistanceBond[0][0]: no number, or not that of the mirrored entry",
        ),
        (
            "flag",
            with("model", "shearStress", 7.into()),
            "case.json, model.shearStress: expected true, false, \"on\" or \"off\", found 7",
        ),
    ];
    for (name, text, expected) in table {
        assert_eq!(refusal(name, &text), expected);
    }
}

#[test]
fn a_case_with_another_coefficient_fails() {
    let scratch = Scratch::new("fails");
    let samples = Path::new(CONTACT).join("hertz_hist_slip_spin/samples.csv");
    fs::copy(samples, scratch.0.join("samples.csv")).unwrap();
    let folder = scratch.case(&changed(&text_of("hertz_hist_slip_spin"), "\"radius\": 0.00", "\"radius\": 0.01"));
    let report = replay(&folder, &Options::default()).unwrap();
    assert!(!report.passed(), "{report}");
    assert!(report.to_string().ends_with("FAIL"), "{report}");
}

#[test]
fn a_case_without_samples_runs_freely_and_is_written_in_their_columns() {
    let scratch = Scratch::new("free");
    let folder = scratch.case(&text_of("hertz_chain3"));
    let out = scratch.0.join("out");
    let report = replay(&folder, &Options { write: Some(out.clone()), ..Options::default() }).unwrap();
    assert!(report.passed() && report.errors.is_none(), "{report}");
    let ours = fs::read_to_string(out.join(folder.file_name().unwrap()).with_extension("csv")).unwrap();
    let theirs = fs::read_to_string(Path::new(CONTACT).join("hertz_chain3/samples.csv")).unwrap();
    let key = |line: &str| line.split(',').take(3).map(str::to_owned).collect::<Vec<_>>();
    let (ours, theirs): (Vec<&str>, Vec<&str>) = (ours.lines().collect(), theirs.lines().collect());
    assert_eq!(ours[0], theirs[0]);
    assert_eq!(ours.len(), theirs.len());
    for (our, their) in ours.iter().zip(&theirs).skip(1) {
        assert_eq!((&key(our)[0], &key(our)[2]), (&key(their)[0], &key(their)[2]));
    }
}

#[test]
fn flags_that_are_not_written_take_their_defaults() {
    let whole = text_of("hertz_hist_slip_spin");
    let mut bare: serde_json::Value = serde_json::from_str(&whole).unwrap();
    let model = bare["model"].as_object_mut().unwrap();
    model.retain(|key, _| ["normal", "tangential"].contains(&key.as_str()));
    let scratch = Scratch::new("defaults");
    let samples = Path::new(CONTACT).join("hertz_hist_slip_spin/samples.csv");
    fs::copy(samples, scratch.0.join("samples.csv")).unwrap();
    let report = replay(&scratch.case(&bare.to_string()), &Options::default()).unwrap();
    assert!(report.passed(), "{report}");
}

#[test]
fn a_folder_without_cases_is_refused() {
    let scratch = Scratch::new("none");
    let message = find(std::slice::from_ref(&scratch.0)).unwrap_err().to_string();
    assert!(message.ends_with("expected a case, or a folder of cases, found no case.json here or in a folder below"));
}

#[test]
fn bad_cases_are_refused_with_field_finding_and_remedy() {
    let good = text_of("hertz_hist_slip_spin");
    let with = |from: &str, to: &str| changed(&good, from, to);
    let table = [
        ("syntax", "{\n \"dt\": ,".to_owned(), "case.json, line 2: expected value at line 2 column 8"),
        ("step", with("\"dt\": ", "\"dt\": -"), "case.json, dt: expected a number above 0, found -"),
        (
            "steps",
            with("\"steps\": 450", "\"steps\": 0"),
            "case.json, steps, sample_every: expected numbers above 0, found 0",
        ),
        (
            "model",
            with("\"normal\": \"hertz\"", "\"normal\": \"luding\""),
            "case.json, model.normal: expected hertz, hooke, hertz/stiffness, hooke/stiffness, edinburgh, jkr or \
             dmt, found \"luding\"",
        ),
        (
            "bond",
            with("\"cohesion\": \"off\"", "\"cohesion\": \"bond\""),
            "case.json, pair_properties.tsCreateBond: expected a step, found nothing",
        ),
        (
            "property",
            with("coefficientFriction", "coefficientFiction"),
            "case.json, pair_properties.coefficientFiction: not known here",
        ),
        (
            "flag",
            with("\"viscous\": false", "\"viscous\": true"),
            "case.json, model.viscous: expected false, as this flag belongs to hooke alone, found true",
        ),
        (
            "type",
            with("\"type\": 2", "\"type\": 3"),
            "case.json, particles[1].type: expected a material from 1 to \
                                                      2, found 3",
        ),
        ("id", with("\"id\": 2", "\"id\": 1"), "case.json, particles: two of them have id 1"),
        (
            "radius",
            with("\"radius\": 0.0", "\"radius\": -0.0"),
            "case.json, particles[0].radius: expected a number above 0, found -0.0",
        ),
        (
            "speed",
            with("\"normal\": \"hertz\"", "\"normal\": \"hooke\""),
            "case.json, scalar_properties.characteristicVelocity: absent; the chosen model needs it",
        ),
    ];
    for (name, text, expected) in table {
        let found = refusal(name, &text);
        assert!(found.starts_with(expected), "{found}\nexpected\n{expected}");
    }
}

#[test]
fn asymmetric_and_absent_properties_are_refused() {
    let mut case: serde_json::Value = serde_json::from_str(&text_of("hertz_hist_slip_spin")).unwrap();
    case["pair_properties"]["coefficientFriction"] = serde_json::json!([[0.3, 0.2], [0.25, 0.3]]);
    assert_eq!(
        refusal("asymmetric", &case.to_string()),
        "case.json, pair_properties.coefficientFriction: expected a symmetric matrix, found [1][0] is 0.25 and \
         [0][1] is 0.2"
    );
    case["pair_properties"].as_object_mut().unwrap().remove("coefficientFriction");
    assert_eq!(
        refusal("absent", &case.to_string()),
        "case.json, pair_properties.coefficientFriction: absent; the chosen model needs it"
    );
}

#[test]
fn bad_samples_are_refused_with_their_line() {
    let whole = fs::read_to_string(Path::new(CONTACT).join("hertz_headon/samples.csv")).unwrap();
    let with_samples = |name: &str, samples: &str| {
        let scratch = Scratch::new(name);
        fs::write(scratch.0.join("samples.csv"), samples).unwrap();
        let folder = scratch.case(&text_of("hertz_headon"));
        let message = replay(&folder, &Options::default()).unwrap_err().to_string();
        message.replace(&format!("{}/", folder.display()), "")
    };
    let header = whole.lines().next().unwrap();
    let row = whole.lines().nth(1).unwrap();
    assert!(
        with_samples("column", &whole.replacen(",tz", ",t", 1)).starts_with("samples.csv, line 1: no column \"tz\"")
    );
    assert_eq!(
        with_samples("row", &format!("{header}\n{row}\n")),
        "samples.csv, line 1: no row of particle 2 at step 0"
    );
    assert_eq!(
        with_samples("twice", &format!("{header}\n{row}\n{row}\n")),
        "samples.csv, line 3: a second row of particle 1 at step 0"
    );
    let foreign = row.replacen("0,0,1,", "0,0,7,", 1);
    assert_eq!(
        with_samples("foreign", &format!("{header}\n{foreign}\n")),
        "samples.csv, line 2: id 7 is not a particle of the case"
    );
    let not_finite = row.replacen("0,0,1,", "0,0,1,nan,", 1);
    assert_eq!(
        with_samples("nan", &format!("{header}\n{not_finite}\n")),
        "samples.csv, line 2: x: expected a finite number, found \"nan\""
    );
}

#[test]
fn temperatures_and_heat_flows_of_other_engines_are_reproduced() {
    let cases = find(&[HEAT.into()]).unwrap();
    assert_eq!(cases.len(), 14);
    let reports: Vec<_> = cases.iter().map(|case| replay(case, &Options::default()).unwrap()).collect();
    assert!(reports.iter().all(|report| report.heat.is_some()));
    let failed: Vec<String> = reports.iter().filter(|report| !report.passed()).map(ToString::to_string).collect();
    assert!(failed.is_empty(), "\n{}", failed.join("\n"));
}

#[test]
fn another_conductivity_fails() {
    let folder = Path::new(HEAT).join("l01_two_overlap");
    let case = fs::read_to_string(folder.join("case.json")).unwrap();
    let scratch = Scratch::new("conductivity");
    fs::copy(folder.join("heat.csv"), scratch.0.join("heat.csv")).unwrap();
    let changed = scratch.case(&changed(&case, "\"conductivity\": 5.0", "\"conductivity\": 5.0001"));
    assert!(!replay(&changed, &Options::default()).unwrap().passed());
}
