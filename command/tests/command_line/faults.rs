//! Disks that fill, folders that cannot be written, kills at any moment: told in words with status 1, and the run that goes on ends with
//! the bytes of one that was left alone.

use crate::ground::{ALL_OUTPUTS, Place, assert_same, cograin, complaint, results};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Instant;

/// Many outputs in little time.
const RUN: &str = "end = 0.2\nstep = 1e-5";

/// The folder of a run that was left alone.
fn whole(place: &Place, scene: &Path) -> PathBuf {
    let out = place.at("whole");
    complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 0);
    out
}

/// A file system of its own, where the test may mount one.
#[cfg(target_os = "linux")]
struct Disk(PathBuf);

#[cfg(target_os = "linux")]
impl Disk {
    /// Of this size.
    fn mounted(place: &Place, size: &str) -> Option<Self> {
        let path = place.at("disk");
        fs::create_dir_all(&path).unwrap();
        let mount = Command::new("mount").args(["-t", "tmpfs", "-o", size, "none"]).arg(&path).output();
        mount.is_ok_and(|mount| mount.status.success()).then_some(Self(path))
    }

    /// With other options from now on.
    fn remount(&self, options: &str) {
        let options = format!("remount,{options}");
        assert!(Command::new("mount").args(["-o", &options]).arg(&self.0).status().unwrap().success());
    }
}

#[cfg(target_os = "linux")]
impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(&self.0).status();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_stops_a_run_that_then_goes_on_to_the_same_bytes() {
    let place = Place::new("full_disk");
    let (scene, whole) = (place.scene(RUN, ALL_OUTPUTS), place.scene(RUN, ALL_OUTPUTS));
    let whole = self::whole(&place, &whole);
    let size: usize = results(&whole).values().map(Vec::len).sum();
    let Some(disk) = Disk::mounted(&place, &format!("size={}k", size / 1024 * 2 / 3)) else {
        println!("no file system may be mounted here");
        return;
    };
    let out = disk.0.join("out");
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &out]).output().unwrap(), 1);
    assert!(said.contains("cannot be written") && said.contains("No space left"), "{said}");
    // Still full: it says so again, and what there is stays.
    let said = complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume"]).output().unwrap(), 1);
    assert!(said.contains("No space left"), "{said}");
    disk.remount("size=64m");
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume"]).output().unwrap(), 0);
    assert_same(&out, &whole);
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_cannot_be_written_is_told_and_keeps_what_it_has() {
    let place = Place::new("read_only");
    let scene = place.scene(RUN, ALL_OUTPUTS);
    let Some(disk) = Disk::mounted(&place, "size=4m") else {
        println!("no file system may be mounted here");
        return;
    };
    let earlier = disk.0.join("out");
    complaint(&cograin(&[&"run", &scene, &"-o", &earlier]).output().unwrap(), 0);
    let before = results(&earlier);
    disk.remount("ro");
    let told = |done: &Output| assert!(complaint(done, 1).contains("cannot be written: Read-only file system"));
    told(&cograin(&[&"run", &scene, &"-o", &disk.0.join("new")]).output().unwrap());
    for how in [&"--overwrite", &"--resume"] {
        told(&cograin(&[&"run", &scene, &"-o", &earlier, how]).output().unwrap());
    }
    told(&cograin(&[&"settle", &scene, &"-o", &disk.0.join("settled.cograin")]).output().unwrap());
    assert!(results(&earlier) == before);
}

#[cfg(unix)]
#[test]
fn a_limit_on_files_stops_a_run_that_then_goes_on_to_the_same_bytes() {
    let place = Place::new("limited_files");
    let scene = place.scene(RUN, ALL_OUTPUTS);
    let (out, whole) = (place.at("out"), whole(&place, &scene));
    let half = results(&whole)["history.csv"].len() / 1024 / 2;
    // In units of 512 bytes.
    let line = format!(
        "ulimit -f {}; exec {} run {} -o {}",
        2 * half,
        env!("CARGO_BIN_EXE_cograin"),
        scene.display(),
        out.display()
    );
    let said = complaint(&Command::new("sh").args(["-c", &line]).output().unwrap(), 1);
    assert!(said.contains("history.csv") && said.contains("cannot be written"), "{said}");
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume"]).output().unwrap(), 0);
    assert_same(&out, &whole);
}

#[test]
fn a_run_that_is_killed_again_and_again_ends_with_the_same_bytes() {
    let place = Place::new("killed_often");
    let scene = place.scene("end = 0.2\nstep = 2e-6", ALL_OUTPUTS);
    let (out, begun) = (place.at("out"), Instant::now());
    let whole = whole(&place, &scene);
    let once = begun.elapsed();
    let (mut killed, mut chance) = (0, 12345_u64);
    for _ in 0..12 {
        let mut command = cograin(&[&"run", &scene, &"-o", &out]);
        if out.join("checkpoint.cograin").exists() {
            command.arg("--resume");
        } else {
            command.arg("--overwrite");
        }
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        chance = chance.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // From before its first file to a good way.
        sleep(once.mul_f64((chance >> 40) as f64 / f64::from(1 << 24) / 4.0));
        killed += usize::from(child.try_wait().unwrap().is_none());
        let _ = child.kill();
        child.wait().unwrap();
    }
    assert!(killed > 3, "{killed} of 12 were still at work");
    complaint(&cograin(&[&"run", &scene, &"-o", &out, &"--resume"]).output().unwrap(), 0);
    assert_same(&out, &whole);
}
