//! Frames that a unit writes: the files that a run of the scene writes, whatever the host does in between.

use super::host::{Host, Unpacked, source};
use crate::types::Status;
use crate::v2::values::*;
use crate::v2::*;
use cograin::interface::FRAMES;
use cograin::run::{EarlierResults, RunOrder, Start, run};
use cograin::scene::{Scene, Source};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::ptr;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Time between frames \[s\].
const INTERVAL: f64 = 1.0e-3;

/// The bed with these lines of `[output]`, up to 4 ms.
fn with(output: &str) -> Source {
    let mut source = source();
    source.text = source.text.replace("energy = true", output).replace("end = 0.1", "end = 4.0e-3");
    source
}

/// The bed with every kind of frame.
fn framed() -> Source {
    with("frame_interval = 1.0e-3\ncontacts = true\nboundaries = true")
}

/// A name for a folder that is not there; what is there in the end is removed.
struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("cograin-frames-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        Self(path)
    }

    fn name(&self) -> &str {
        self.0.to_str().unwrap()
    }

    /// The frames and their collections: what each file holds, by name.
    fn frames(&self) -> BTreeMap<String, Vec<u8>> {
        frames(&self.0)
    }

    /// Times and files of a collection.
    fn collection(&self, kind: &str) -> Vec<(f64, String)> {
        let text = fs::read_to_string(self.0.join(format!("{kind}.pvd"))).unwrap();
        assert!(text.ends_with("</Collection>\n</VTKFile>\n"), "{text}");
        let entries = text.lines().filter(|line| line.starts_with("<DataSet"));
        let part = |line: &str, key: &str| {
            line.split(&format!("{key}=\"")).nth(1).unwrap().split('"').next().unwrap().to_owned()
        };
        entries.map(|line| (part(line, "timestep").parse().unwrap(), part(line, "file"))).collect()
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0).or_else(|_| fs::remove_file(&self.0));
    }
}

/// The frames and their collections in a folder.
fn frames(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = entries.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), path));
    let kept = named.filter(|(name, _)| name.ends_with(".vtu") || name.ends_with(".pvd"));
    kept.map(|(name, path)| (name, fs::read(path).unwrap())).collect()
}

/// What a run of the scene writes.
fn of_a_run(source: &Source, name: &str) -> BTreeMap<String, Vec<u8>> {
    let (scene, place) = (Arc::new(Scene::from_source(source).unwrap()), Place::new(name));
    let order = RunOrder {
        scene: &scene,
        scene_name: "scene.toml",
        folder: &place.0,
        end: None,
        start: &Start::Scene,
        earlier_results: EarlierResults::Keep,
        inputs: None,
        stop: &AtomicBool::new(false),
    };
    run(order, &mut |_| {}).unwrap();
    place.frames()
}

/// An instance with frames in a folder, ready for its first step.
fn started<'a>(unit: &'a Unpacked, place: &Place) -> Host<'a> {
    let host = Host::instantiated(unit);
    assert_eq!(host.set_text(FRAMES, place.name()), Status::Ok, "{}", host.said());
    assert_eq!(start(&host), Status::Ok, "{}", host.said());
    host
}

/// Starts an instance that was made before.
fn start(host: &Host) -> Status {
    assert_eq!(fmi2SetupExperiment(host.component, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    fmi2ExitInitializationMode(host.component)
}

/// Makes steps of one length.
fn go(host: &Host, from: u32, count: u32, length: f64) {
    for index in from..from + count {
        assert_eq!(host.step(f64::from(index) * length, length), Status::Ok, "{}", host.said());
    }
}

#[test]
fn a_unit_writes_the_files_of_a_run_whatever_its_communication_steps() {
    let expected = of_a_run(&framed(), "run");
    assert_eq!(expected.len(), 3 * (5 + 1), "{:?}", expected.keys());
    let unit = Unpacked::of(&framed(), "framed");
    for parts in [1, 4, 100] {
        let place = Place::new(&format!("parts{parts}"));
        let host = started(&unit, &place);
        assert_eq!(host.text(FRAMES), place.name());
        go(&host, 0, 4 * parts, INTERVAL / f64::from(parts));
        assert_eq!(fmi2Terminate(host.component), Status::Ok);
        assert!(place.frames() == expected, "{parts} communication steps a frame");
    }
}

#[test]
fn the_last_state_has_a_frame_and_bonds_have_theirs() {
    let bonds = "\n[bond.neck]\nbetween = [\"bed\", \"bed\"]\ncreate_distance = 0.0202\nnormal_stiffness = 1.0e10\n\
                 tangential_stiffness = 5.0e9\n";
    let mut source = with("frame_interval = 1.5e-3");
    source.text += bonds;
    let expected = of_a_run(&source, "bonded-run");
    assert!(expected.contains_key("bonds_000003.vtu"), "{:?}", expected.keys());
    let (unit, place) = (Unpacked::of(&source, "bonded"), Place::new("bonded"));
    let host = started(&unit, &place);
    go(&host, 0, 8, 5.0e-4);
    assert_eq!(fmi2Terminate(host.component), Status::Ok);
    assert!(place.frames() == expected, "{:?}", place.frames().keys());
}

#[test]
fn frames_change_nothing_of_the_course() {
    let (unit, place) = (Unpacked::of(&framed(), "watched"), Place::new("watched"));
    let plain = Unpacked::of(&with("energy = true"), "plain");
    let watched = started(&unit, &place);
    let unwatched = Host::started(&unit);
    assert!(watched.shake(0, 12) == unwatched.shake(0, 12));
    assert_eq!(place.collection("particles").len(), 3, "0, 1 and 2 ms");
    let parameters = |unit: &Unpacked| unit.interface.variables().iter().filter(|it| it.name == FRAMES).count();
    assert_eq!((parameters(&unit), parameters(&plain)), (1, 1), "every unit has it");
}

#[test]
fn without_an_interval_every_communication_point_has_a_frame() {
    let (unit, place) = (Unpacked::of(&with("energy = true"), "each"), Place::new("each"));
    let host = started(&unit, &place);
    go(&host, 0, 3, 2.0e-4);
    assert_eq!(fmi2Terminate(host.component), Status::Ok);
    let times: Vec<f64> = place.collection("particles").into_iter().map(|(time, _)| time).collect();
    assert_eq!(times, [0.0, 2.0e-4, 4.0e-4, 2.0 * 2.0e-4 + 2.0e-4]);
    assert!(!place.0.join("boundaries.pvd").exists());
}

#[test]
fn points_that_miss_the_interval_have_the_frame_as_soon_as_they_are_past_it() {
    let unit = Unpacked::of(&framed(), "missed");
    for (length, count, expected) in [
        (7.0e-4, 6, vec![(0.0, 0), (1.4e-3, 1), (2.1e-3, 2), (3.5e-3, 3), (4.2e-3, 4)]),
        (2.5e-3, 2, vec![(0.0, 0), (2.5e-3, 2), (5.0e-3, 5)]),
    ] {
        let place = Place::new(&format!("missed{count}"));
        let host = started(&unit, &place);
        go(&host, 0, count, length);
        assert_eq!(fmi2Terminate(host.component), Status::Ok);
        let found = place.collection("particles");
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for ((time, file), (at, number)) in found.into_iter().zip(expected) {
            assert!((time - at).abs() < 1e-12, "{time} and {at}");
            assert_eq!(file, format!("particles_{number:06}.vtu"));
            assert!(place.0.join(file).exists());
        }
    }
}

#[test]
fn a_master_that_repeats_its_steps_leaves_the_frames_of_the_steps_that_count() {
    let unit = Unpacked::of(&framed(), "repeated");
    let (place, straight) = (Place::new("repeated"), Place::new("straight"));
    let (host, other) = (started(&unit, &place), started(&unit, &straight));
    let length = 5.0e-4;
    for index in 0..8_u32 {
        let (from, aim) = (f64::from(index) * length, -2.0e-6 * f64::from(index + 1));
        let before = host.save();
        for guess in [-1.0e-4, 5.0e-5] {
            assert_eq!(host.set("grip.displacement.z", guess), Status::Ok);
            assert_eq!(host.step(from, length), Status::Ok, "{}", host.said());
            assert!(place.collection("particles").iter().all(|(time, _)| *time <= from), "none of a guess");
            assert_eq!(fmi2SetFMUstate(host.component, before), Status::Ok, "{}", host.said());
        }
        for each in [&host, &other] {
            assert_eq!(each.set("grip.displacement.z", aim), Status::Ok);
            assert_eq!(each.step(from, length), Status::Ok, "{}", each.said());
        }
    }
    // a long way back, and another way on
    let end = host.save();
    for each in [&host, &other] {
        assert_eq!(fmi2Terminate(each.component), Status::Ok);
    }
    assert_eq!(straight.collection("particles").len(), 5);
    assert!(place.frames() == straight.frames());
    assert_eq!(fmi2SetFMUstate(host.component, end), Status::Ok);
    assert_eq!(place.collection("contacts").len(), 4, "the last frame is taken back until the unit goes on");
    assert!(!place.0.join("particles_000004.vtu").exists());
    assert_eq!(fmi2Terminate(host.component), Status::Ok);
    assert!(place.frames() == straight.frames());
}

#[test]
fn a_restored_state_takes_back_the_frames_of_its_future() {
    let (unit, place) = (Unpacked::of(&framed(), "back"), Place::new("back"));
    let host = started(&unit, &place);
    go(&host, 0, 5, INTERVAL / 4.0);
    let early = host.save();
    go(&host, 5, 9, INTERVAL / 4.0);
    assert_eq!(place.collection("boundaries").len(), 4);
    assert_eq!(fmi2SetFMUstate(host.component, early), Status::Ok, "{}", host.said());
    assert_eq!(place.collection("boundaries").len(), 2);
    assert!(place.0.join("boundaries_000001.vtu").exists() && !place.0.join("boundaries_000002.vtu").exists());
    go(&host, 5, 11, INTERVAL / 4.0);
    assert_eq!(fmi2Terminate(host.component), Status::Ok);
    assert!(place.frames() == of_a_run(&framed(), "back-run"));
}

#[test]
fn a_restored_start_takes_back_all_frames_and_can_be_made_again() {
    let (unit, place) = (Unpacked::of(&framed(), "anew"), Place::new("anew"));
    let host = Host::instantiated(&unit);
    assert_eq!(host.set_text(FRAMES, place.name()), Status::Ok);
    assert_eq!(fmi2SetupExperiment(host.component, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    let before = host.save();
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok);
    go(&host, 0, 2, INTERVAL);
    assert_eq!(fmi2SetFMUstate(host.component, before), Status::Ok, "{}", host.said());
    assert_eq!(fs::read_dir(&place.0).unwrap().count(), 0, "nothing is left, the lock neither");
    assert_eq!(host.text(FRAMES), place.name(), "no state changes it");
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok, "{}", host.said());
    go(&host, 0, 4, INTERVAL);
    assert_eq!(fmi2Terminate(host.component), Status::Ok);
    assert!(place.frames() == of_a_run(&framed(), "anew-run"));
}

#[test]
fn an_instance_that_takes_a_state_from_elsewhere_begins_its_frames_there() {
    let unit = Unpacked::of(&framed(), "elsewhere");
    let (one, two) = (Place::new("elsewhere1"), Place::new("elsewhere2"));
    let host = started(&unit, &one);
    go(&host, 0, 2, INTERVAL);
    let bytes = host.serialize(host.save());
    let other = Host::instantiated(&unit);
    assert_eq!(other.set_text(FRAMES, two.name()), Status::Ok);
    let state = other.deserialize(&bytes);
    assert_eq!(fmi2SetFMUstate(other.component, state), Status::Ok, "{}", other.said());
    for each in [&host, &other] {
        go(each, 2, 2, INTERVAL);
        assert_eq!(fmi2Terminate(each.component), Status::Ok);
    }
    let numbers = |place: &Place| -> Vec<(f64, String)> { place.collection("particles") };
    assert_eq!(numbers(&two), numbers(&one)[2..]);
    for (_, file) in numbers(&two) {
        assert!(fs::read(one.0.join(&file)).unwrap() == fs::read(two.0.join(&file)).unwrap(), "{file}");
    }
}

#[test]
fn a_folder_that_cannot_be_had_is_refused_in_words_and_another_one_can_be_named() {
    let (unit, place, full) = (Unpacked::of(&framed(), "refused"), Place::new("refused"), Place::new("used"));
    let first = started(&unit, &full);
    let host = Host::instantiated(&unit);
    let file = Place::new("file");
    fs::write(&file.0, "no folder").unwrap();
    let blocked = Place::new("blocked");
    fs::create_dir_all(blocked.0.join("boundaries_000000.vtu")).unwrap();
    assert_eq!(fmi2SetupExperiment(host.component, 0, 0.0, 0.0, 0, 0.0), Status::Ok);
    assert_eq!(fmi2EnterInitializationMode(host.component), Status::Ok);
    let refused = |name: &str, words: &[&str]| {
        assert_eq!(host.set_text(FRAMES, name), Status::Ok);
        host.refused(fmi2ExitInitializationMode(host.component), &[&["run.frames: ", name], words].concat());
    };
    refused(file.name(), &["expected a folder, or a name that is not there yet, found a file"]);
    assert_eq!(host.set_text(FRAMES, &format!("{}/below", file.name())), Status::Ok);
    host.refused(fmi2ExitInitializationMode(host.component), &["run.frames: ", file.name(), "found a file"]);
    refused(full.name(), &["in use by process", "take another folder"]);
    refused(blocked.name(), &["boundaries_000000.vtu", "cannot be written"]);
    assert_eq!(fs::read_dir(&blocked.0).unwrap().count(), 1, "nothing is left there");
    drop(first);
    refused(
        full.name(),
        &["found results of an earlier run", "expected an empty folder, or a name that is not there yet"],
    );
    assert_eq!(host.set_text(FRAMES, place.name()), Status::Ok);
    assert_eq!(fmi2ExitInitializationMode(host.component), Status::Ok, "{}", host.said());
    host.refused(host.set_text(FRAMES, ""), &[FRAMES, "fixed parameter", "until the initialisation mode ends"]);
    go(&host, 0, 4, INTERVAL);
    assert_eq!(fmi2Terminate(host.component), Status::Ok);
    assert!(place.frames() == of_a_run(&framed(), "refused-run"));
}

#[test]
fn texts_that_are_none_are_refused() {
    let unit = Unpacked::of(&framed(), "texts");
    let host = Host::instantiated(&unit);
    let (reference, number) = (unit.reference(FRAMES), unit.reference("run.time_step"));
    let bytes = [0xff_u8, 0];
    let (wrong, none) = (bytes.as_ptr().cast(), ptr::null());
    // SAFETY: one reference and one text each.
    unsafe {
        host.refused(fmi2SetString(host.component, &raw const reference, 1, &raw const wrong), &["expected UTF-8"]);
        host.refused(fmi2SetString(host.component, &raw const reference, 1, &raw const none), &["null"]);
        let text = c"here".as_ptr();
        host.refused(
            fmi2SetString(host.component, &raw const number, 1, &raw const text),
            &["run.time_step", "type String"],
        );
    }
    host.refused(host.set(FRAMES, 1.0), &[FRAMES, "type Real, found String"]);
}

#[test]
fn a_folder_that_is_lost_on_the_way_costs_a_warning_and_nothing_else() {
    let unit = Unpacked::of(&framed(), "lost");
    for blocked in [false, true] {
        let place = Place::new(&format!("lost{blocked}"));
        let (host, other) = (started(&unit, &place), Host::started(&unit));
        go(&host, 0, 1, INTERVAL);
        if blocked {
            fs::create_dir_all(place.0.join("contacts_000001.vtu")).unwrap();
        } else {
            fs::remove_dir_all(&place.0).unwrap();
        }
        assert_eq!(host.step(INTERVAL, INTERVAL), Status::Warning);
        let (status, category, said) = host.heard().pop().unwrap();
        assert_eq!((status, category.as_str()), (Status::Warning, "logStatusWarning"));
        for word in
            ["fmi2DoStep: run.frames: ", "cannot be written", "no more frames are written, everything else goes on"]
        {
            assert!(said.contains(word), "{said}");
        }
        go(&host, 2, 2, INTERVAL);
        go(&other, 0, 4, INTERVAL);
        assert_eq!(host.outputs(), other.outputs());
        assert_eq!(fmi2Terminate(host.component), Status::Ok);
        if blocked {
            assert_eq!(place.collection("particles").len(), 2, "each collection is whole");
            assert_eq!(place.collection("contacts").len(), 1);
        }
    }
}

#[test]
fn reset_and_freeing_leave_whole_collections_and_give_the_folder_back() {
    let (unit, place) = (Unpacked::of(&framed(), "reset"), Place::new("reset"));
    let host = started(&unit, &place);
    go(&host, 0, 2, INTERVAL);
    assert!(place.0.join(".cograin-lock").exists());
    assert_eq!(fmi2Reset(host.component), Status::Ok);
    let times = |place: &Place| place.collection("particles").into_iter().map(|(time, _)| time).collect::<Vec<_>>();
    assert_eq!(times(&place), [0.0, 1.0e-3, 2.0e-3]);
    assert!(!place.0.join(".cograin-lock").exists());
    assert_eq!(start(&host), Status::Ok);
    assert_eq!(host.text(FRAMES), "", "reset takes the start value");
    drop(host);
    let second = Place::new("freed");
    let host = started(&unit, &second);
    go(&host, 0, 3, INTERVAL / 2.0);
    drop(host);
    assert_eq!(times(&second), [0.0, 1.0e-3]);
    assert!(!second.0.join(".cograin-lock").exists());
}
