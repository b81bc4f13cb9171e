//! Communication points stand where readers expect them, wherever a run begins.

use super::*;
use crate::scene::{Output, SceneDraft};

/// The schedule of these outputs.
fn of(output: Output, end: f64) -> Result<Schedule, Refusal> {
    Schedule::new(&SceneDraft { output, ..SceneDraft::default() }.build().unwrap(), "scene.toml", end)
}

/// A schedule with these intervals of history and frames.
fn schedule(history: f64, frames: Option<f64>, end: f64) -> Schedule {
    of(Output { history_interval: Some(history), frame_interval: frames, ..Output::default() }, end).unwrap()
}

/// All points of a run from `time` on.
fn points(schedule: &Schedule, mut time: f64) -> Vec<Point> {
    let mut all = Vec::new();
    while let Some(point) = schedule.after(time) {
        time = point.time;
        all.push(point);
    }
    all
}

#[test]
fn times_are_the_decimal_numbers_a_reader_expects() {
    let times: Vec<_> = points(&schedule(0.1, None, 1.0), 0.0).iter().map(|point| point.time).collect();
    assert_eq!(times, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
}

#[test]
fn every_output_is_at_a_multiple_of_its_interval_and_at_the_end() {
    let all = points(&schedule(2e-3, Some(3e-3), 7e-3), 0.0);
    let found: Vec<_> = all.iter().map(|point| (point.time, point.due.history, point.due.frame)).collect();
    let expected =
        [(2e-3, true, false), (3e-3, false, true), (4e-3, true, false), (6e-3, true, true), (7e-3, true, true)];
    assert_eq!(found, expected);
}

#[test]
fn a_run_started_anywhere_takes_the_same_steps() {
    let schedule = schedule(3.3e-4, Some(1.0e-3), 0.05);
    let whole = points(&schedule, 0.0);
    for start in 0..whole.len() {
        let saved = whole[start].time * (1.0 + 1e-12);
        let rest = points(&schedule, schedule.point_of(saved).unwrap());
        assert_eq!(rest, whole[start + 1..], "from point {start}");
    }
}

#[test]
fn times_that_differ_by_rounding_are_one() {
    let all = points(&schedule(0.1, Some(0.3), 0.9), 0.0);
    assert_eq!(all.len(), 9);
    assert_eq!(all.iter().filter(|point| point.due.frame).count(), 3);
}

#[test]
fn what_was_written_follows_from_the_time() {
    let schedule = schedule(2e-3, Some(3e-3), 7e-3);
    assert_eq!((schedule.rows_until(0.0), schedule.frames_until(0.0).len()), (1, 1));
    assert_eq!((schedule.rows_until(6e-3), schedule.frames_until(6e-3)), (4, vec![0.0, 3e-3, 6e-3]));
    assert_eq!((schedule.rows_until(7e-3), schedule.frames_until(7e-3)), (5, vec![0.0, 3e-3, 6e-3, 7e-3]));
}

#[test]
fn counts_that_nobody_can_mean_are_refused() {
    let frames = |interval| of(Output { frame_interval: Some(interval), ..Output::default() }, 1e-3);
    let told = frames(1e-300).unwrap_err().to_string();
    let expected = "scene.toml, [output] frame_interval: expected at most 1e6 frames up to t = 0.001 s, found 1.000e297, one \
         every 1e-300 s";
    assert_eq!(told, expected);
    assert!(frames(1e-9).is_ok());
    let rows = |interval| of(Output { history_interval: Some(interval), ..Output::default() }, 1.0);
    assert!(rows(1e-12).is_err() && rows(1e-8).is_ok());
    let run = crate::scene::Run { step: Step::Given(1e-30), ..Default::default() };
    let told = Schedule::new(&SceneDraft { run, ..SceneDraft::default() }.build().unwrap(), "scene.toml", 1.0)
        .unwrap_err()
        .to_string();
    assert!(told.starts_with("scene.toml, [run] step: expected at most "), "{told}");
    assert!(told.ends_with("time steps up to t = 1 s, found 1.000e30 of 1e-30 s"), "{told}");
}

#[test]
fn steps_that_outputs_shorten_are_counted() {
    let even = schedule(1e-3, None, 0.01).steps(0.0, 1e-4);
    assert_eq!(even, Counted { all: 100, shortened: 0 });
    // Between 3 ms and 4 ms, 6 ms and so on there is 1 ms: 2 steps of 0.5 ms instead of 0.6 ms; 2 ms has 4 of 0.5 ms.
    let uneven = schedule(2e-3, Some(3e-3), 6e-3).steps(0.0, 6e-4);
    assert_eq!(uneven, Counted { all: 12, shortened: 12 });
    assert_eq!(schedule(1e-3, None, 0.01).checkpoints(0.0), None);
}

#[test]
fn a_time_between_two_points_is_told_the_nearest() {
    assert_eq!(schedule(2e-3, None, 1e-2).point_of(5.1e-3), Err(6e-3));
}

#[test]
fn a_scene_without_intervals_has_a_hundred_points_and_two_rows() {
    let plain = of(Output::default(), 0.5).unwrap();
    let all = points(&plain, 0.0);
    assert_eq!(all.len(), 100);
    assert_eq!(all.iter().filter(|point| point.due.history).count(), 1);
    assert_eq!((plain.rows_until(0.25), plain.rows_until(0.5)), (1, 2));
}

#[test]
fn a_frame_is_due_at_the_first_point_from_outside_that_is_not_before_it() {
    let frames = FrameSchedule { series: Some(Series::every(0.1)) };
    // A clock that sums up its steps.
    let (mut time, mut last, mut found) = (0.0, None, Vec::new());
    for _ in 0..=3000 {
        if let Some(frame) = frames.due(time, last) {
            last = Some(frame);
            found.push((frame.number, frame.time));
        }
        time += 1e-4;
    }
    let expected: Vec<_> = (0..=3_usize).map(|k| (k, k as f64 / 10.0)).collect();
    assert_eq!(found, expected);
    let last = Some(Frame { number: 3, time: 0.3 });
    assert_eq!(frames.due(0.65, last), Some(Frame { number: 6, time: 0.65 }));
    assert_eq!(frames.due(0.35, last), None);
    let each = FrameSchedule { series: None };
    assert_eq!(each.due(0.35, last), Some(Frame { number: 4, time: 0.35 }));
    assert_eq!(each.due(0.3, last), None);
}

/// The next of a row of numbers that look random (Numerical Recipes' 64-bit congruence), from 0 to 1.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn a_schedule_gets_on_row_by_row_up_to_the_most_rows_there_may_be() {
    let mut seed = 1;
    for round in 0..200 {
        // Decimal intervals, as people write them, and any other.
        let digits = (random(&mut seed) * 12.0).floor() - 9.0;
        let decimal = format!("{}e{digits}", 1 + round % 9).parse::<f64>().unwrap();
        let interval = if round % 2 == 0 { decimal } else { decimal * (1.0 + random(&mut seed)) };
        let frames = (round % 3 == 0).then_some(1000.0 * interval);
        let schedule = schedule(interval, frames, 1e8 * interval);
        for _ in 0..20 {
            let count = (random(&mut seed) * 99_999_000.0) as u64;
            let series = Series::every(interval);
            let mut time = series.time(count);
            assert_eq!(schedule.point_of(time), Ok(time));
            for row in 1..200 {
                let point = schedule.after(time).unwrap();
                assert!(point.time > time && point.interval > 0.5 * interval, "{interval} s: {time} s, then {point:?}");
                assert!(point.due.history);
                assert_eq!(schedule.rows_until(point.time), count + row + 1, "{interval} s, {point:?}");
                time = point.time;
            }
        }
        assert_eq!(schedule.rows_until(schedule.end()), 100_000_001);
    }
}

#[test]
fn a_schedule_passes_the_rows_where_it_once_stood_still() {
    let schedule = schedule(1e-5, None, 128.001);
    let mut time = schedule.point_of(127.9999).unwrap();
    for _ in 0..50 {
        time = schedule.after(time).unwrap().time;
    }
    assert_eq!(time, schedule.point_of(128.0004).unwrap());
}

#[test]
fn times_are_the_same_in_any_units_of_powers_of_two() {
    for interval in [0.1, 0.002, 0.3, 1.0 / 3.0, 2.5e-4, 0.7, 1.25] {
        for scale in [-30, -20, 6, 20].map(|power| 2.0_f64.powi(power)) {
            let [here, there] = [interval, scale * interval].map(super::Series::every);
            assert!((1..1000).all(|count| there.time(count) == scale * here.time(count)), "{interval} s by {scale}");
        }
    }
}

#[test]
fn intervals_are_those_of_the_scene_and_not_what_rounding_leaves_of_times() {
    for interval in [1e-3, 3.3e-4, 0.1] {
        let all = points(&schedule(interval, None, 100.0 * interval), 0.0);
        assert!(all.iter().all(|point| point.interval == interval), "{interval}: {all:?}");
    }
}
