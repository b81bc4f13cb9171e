//! When a run writes what, and with it how it is divided into communication steps.
//!
//! Each kind of output has an interval; its k-th output is at k × interval, and the last one at the end of the
//! run. A run goes from one of these times to the next in one communication step
//! ([`Simulation::advance`](crate::step::Simulation::advance)) whose length is the difference of the two times
//! as numbers, wherever it was started. A run that is continued at one of them therefore takes the same
//! communication steps as the unbroken run, and gives the same bits. Times are products and no sums, so they do
//! not drift; two of them that differ by rounding alone are one.

use super::error::Refusal;
use crate::scene::{Scene, Step};
use crate::step::divide;

/// Communication steps of a run whose scene names no interval.
const DEFAULT_STEPS: f64 = 100.0;

/// Outputs of each kind there may be: key, what they are, how many. Frames are files, checkpoints are waited for.
const MOST: [(&str, &str, f64); 3] = [
    ("history_interval", "rows of history.csv", 1e8),
    ("frame_interval", "frames", 1e6),
    ("checkpoint_interval", "checkpoints", 1e6),
];

/// Time steps there may be: beyond, a clock of 53 bits no longer tells one from the next.
const MOST_STEPS: f64 = 1e15;

/// Two times closer than this part of an interval are one.
const SAME: f64 = 1e-9;

/// A saved time may be off by this part of the shortest interval.
const NEAR: f64 = 1e-3;

/// Times at equal intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Series {
    /// Interval \[s\].
    interval: f64,
    /// Outputs in a second, where that is a whole number: dividing by it gives the decimal numbers a reader expects.
    per_second: Option<f64>,
}

impl Series {
    /// Times at this interval \[s\].
    fn every(interval: f64) -> Self {
        let rate = (1.0 / interval).round();
        let whole = rate >= 1.0 && (rate * interval - 1.0).abs() < SAME;
        Self { interval, per_second: whole.then_some(rate) }
    }

    /// The time of output `count` \[s\].
    fn time(self, count: u64) -> f64 {
        match self.per_second {
            Some(rate) => count as f64 / rate,
            None => count as f64 * self.interval,
        }
    }

    /// The number of the last output at or before `time`, which may be off by `slack` \[s\].
    fn last(self, time: f64, slack: f64) -> u64 {
        ((time + slack) / self.interval).floor().max(0.0) as u64
    }
}

/// What is to be written at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Due {
    /// Whether a row of the history is due.
    pub history: bool,
    /// Whether a frame is due.
    pub frame: bool,
    /// Whether a checkpoint is due.
    pub checkpoint: bool,
}

/// A communication point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// Time \[s\].
    pub time: f64,
    /// Time since the point before it \[s\].
    pub interval: f64,
    /// What is to be written there.
    pub due: Due,
}

/// Time steps of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counted {
    /// All of them.
    pub all: u64,
    /// Those that are shorter, so that an output is met.
    pub shortened: u64,
}

/// All communication points of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Schedule {
    /// Rows of the history; without an interval there are two, at the start and at the end.
    history: Option<Series>,
    /// Frames, if the scene asks for them.
    frames: Option<Series>,
    /// Checkpoints beside the first and the last, if the scene gives an interval.
    checkpoints: Option<Series>,
    /// What divides a run whose scene names no interval.
    plain: Option<Series>,
    /// The end of the run \[s\].
    end: f64,
}

impl Schedule {
    /// The communication points of a run to `end` \[s\] that writes what the scene asks for; refused where nobody can mean
    /// so many. The name is that of the scene, for the message.
    pub(crate) fn new(scene: &Scene, scene_name: &str, end: f64) -> Result<Self, Refusal> {
        let output = &scene.output;
        let intervals = [output.history_interval, output.frame_interval, output.checkpoint_interval];
        for (interval, (key, what, most)) in intervals.into_iter().zip(MOST) {
            let Some(interval) = interval else { continue };
            let count = end / interval;
            if count > most {
                return Err(Refusal::Counts { scene: scene_name.to_owned(), key, interval, count, what, end, most });
            }
        }
        if let Step::Given(step) = scene.run.step
            && end / step > MOST_STEPS
        {
            let (scene, count) = (scene_name.to_owned(), end / step);
            return Err(Refusal::Steps { scene, step, count, end, most: MOST_STEPS });
        }
        let [history, frames, checkpoints] = intervals.map(|interval| interval.map(Series::every));
        let named = history.or(frames).or(checkpoints).is_some();
        let plain = (!named).then(|| Series::every(end / DEFAULT_STEPS));
        Ok(Self { history, frames, checkpoints, plain, end })
    }

    /// All intervals.
    fn series(&self) -> impl Iterator<Item = Series> {
        [self.history, self.frames, self.checkpoints, self.plain].into_iter().flatten()
    }

    /// The first point after the one at `time` \[s\]; none at the end.
    pub(crate) fn after(&self, time: f64) -> Option<Point> {
        let beyond = |series: Series| series.time(series.last(time, SAME * series.interval) + 1);
        if time >= self.end {
            return None;
        }
        let mut next = self.series().map(beyond).fold(self.end, f64::min);
        if self.series().any(|series| self.end - next < SAME * series.interval) {
            next = self.end;
        }
        let is_due = |series: Option<Series>| {
            series.is_some_and(|series| next >= self.end || beyond(series) - next < SAME * series.interval)
        };
        let due = Due {
            history: is_due(self.history) || next >= self.end,
            frame: is_due(self.frames),
            checkpoint: is_due(self.checkpoints) || next >= self.end,
        };
        Some(Point { time: next, interval: next - time, due })
    }

    /// The end of the run \[s\].
    pub(crate) fn end(&self) -> f64 {
        self.end
    }

    /// Time steps of a run from `time` on \[s\] whose step has this length \[s\].
    pub(crate) fn steps(&self, mut time: f64, step: f64) -> Counted {
        let mut counted = Counted::default();
        while let Some(point) = self.after(time) {
            let (count, length) = divide(point.interval, step);
            counted.all += count;
            counted.shortened += if length == step { 0 } else { count };
            time = point.time;
        }
        counted
    }

    /// Checkpoints of a run from `time` on \[s\], if the scene says when they are written.
    pub(crate) fn checkpoints(&self, time: f64) -> Option<u64> {
        let count = |series| self.regular_until(series, self.end) + 2 - self.regular_until(series, time);
        self.checkpoints.map(count)
    }

    /// The communication point that a saved time stands for, or the nearest one if it stands for none \[s\].
    pub(crate) fn point_of(&self, saved: f64) -> Result<f64, f64> {
        let shortest = self.series().map(|series| series.interval).fold(self.end, f64::min);
        let nearest = self
            .series()
            .flat_map(|series| {
                let last = series.last(saved, 0.0);
                [series.time(last), series.time(last + 1)]
            })
            .filter(|&time| time < self.end)
            .chain([self.end])
            .min_by(|a, b| (a - saved).abs().total_cmp(&(b - saved).abs()))
            .unwrap_or(self.end);
        if (nearest - saved).abs() <= NEAR * shortest { Ok(nearest) } else { Err(nearest) }
    }

    /// Times of the frames up to and with the point at `time` \[s\].
    pub(crate) fn frames_until(&self, time: f64) -> Vec<f64> {
        let Some(series) = self.frames else { return Vec::new() };
        let mut times: Vec<_> = (0..self.regular_until(series, time)).map(|k| series.time(k)).collect();
        if time >= self.end {
            times.push(self.end);
        }
        times
    }

    /// Rows of the history up to and with the point at `time` \[s\].
    pub(crate) fn rows_until(&self, time: f64) -> u64 {
        let regular = self.history.map_or(1, |series| self.regular_until(series, time));
        regular + u64::from(time >= self.end)
    }

    /// Outputs of one kind up to and with the point at `time` \[s\], without the one at the end of the run.
    fn regular_until(&self, series: Series, time: f64) -> u64 {
        let slack = SAME * series.interval;
        let count = series.last(time, slack) + 1;
        if count > 1 && self.end - series.time(count - 1) < slack { count - 1 } else { count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Output;

    /// The schedule of these outputs.
    fn of(output: Output, end: f64) -> Result<Schedule, Refusal> {
        Schedule::new(&Scene { output, ..Scene::default() }, "scene.toml", end)
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
        let expected = "scene.toml, [output] frame_interval: 1e-300 s gives 1.000e297 frames up to t = 0.001 s; at most 1e6 are right";
        assert_eq!(told, expected);
        assert!(frames(1e-9).is_ok());
        let rows = |interval| of(Output { history_interval: Some(interval), ..Output::default() }, 1.0);
        assert!(rows(1e-12).is_err() && rows(1e-8).is_ok());
        let run = crate::scene::Run { step: Step::Given(1e-30), ..Default::default() };
        let told = Schedule::new(&Scene { run, ..Scene::default() }, "scene.toml", 1.0).unwrap_err().to_string();
        assert!(told.starts_with("scene.toml, [run] step: 1e-30 s gives 1.000e30 time steps"), "{told}");
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
}
