//! When a run writes what, and with it how it is divided into communication steps.
//!
//! Each kind of output has an interval; its k-th output is at k × interval, and the last one at the end of the
//! run. A run goes from one of these times to the next in one communication step
//! ([`Simulation::advance`](crate::engine::simulation::Simulation::advance)) whose length is the interval, or the difference of the
//! two times as numbers where these are of several kinds, wherever it was started. A run that is continued at one of them therefore takes the same
//! communication steps as the unbroken run, and gives the same bits. Times are products and no sums, so they do
//! not drift; two of them that differ by rounding alone are one.

use super::failure::Refusal;
use super::frame_files::Frame;
use crate::base::number::binade;
use crate::engine::simulation::divide;
use crate::engine::state::clock::MOST_STEPS;
use crate::scene::{Scene, Step};

/// Communication steps of a run whose scene names no interval.
const DEFAULT_STEPS: f64 = 100.0;

/// Outputs of each kind there may be: key, what they are, how many. Frames are files, checkpoints are waited for.
const MOST: [(&str, &str, f64); 3] = [
    ("history_interval", "rows of history.csv", 1e8),
    ("frame_interval", "frames", 1e6),
    ("checkpoint_interval", "checkpoints", 1e6),
];

/// Two times closer than this part of an interval are one.
const SAME: f64 = 1e-9;

/// Two times closer than this part of themselves differ by rounding alone: they are one, too.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Powers of two among which one is looked for that holds a whole number of intervals.
const MOST_DOUBLINGS: u32 = 31;

/// A communication step this part of a time step off a whole number of steps has that number.
const FITTING: f64 = 1e-6;

/// A saved time may be off by this part of the shortest interval.
const NEAR: f64 = 1e-3;

/// A master that sums up its steps may miss a time by this part of an interval: it has come there.
const ARRIVED: f64 = 1e-6;

/// Times at equal intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Series {
    /// Interval \[s\].
    interval: f64,
    /// Outputs in a power of two of seconds, where that is a whole number, and that power \[s\]: dividing gives the decimal numbers a
    /// reader expects, in any units.
    whole: Option<[f64; 2]>,
}

impl Series {
    /// Times at this interval \[s\].
    fn every(interval: f64) -> Self {
        let unit = binade(1.0 / interval);
        let whole = (0..=MOST_DOUBLINGS).find_map(|doublings| {
            let times = f64::from(1_u32 << doublings);
            let count = (times / (interval * unit)).round();
            ((count * (interval * unit) - times).abs() < ROUNDING * times).then_some([count, times / unit])
        });
        Self { interval, whole }
    }

    /// The time of output `count` \[s\].
    fn time(self, count: u64) -> f64 {
        match self.whole {
            Some([whole, unit]) => count as f64 / whole * unit,
            None => count as f64 * self.interval,
        }
    }

    /// By how much two times at about this one \[s\] may differ and still be one \[s\].
    fn slack(self, time: f64) -> f64 {
        (SAME * self.interval).max(ROUNDING * time)
    }

    /// The number of the last output at or before `time`, which may be off by `slack` \[s\].
    fn last(self, time: f64, slack: f64) -> u64 {
        let mut count = (time / self.interval).floor().max(0.0) as u64;
        // The quotient is rounded; the times of outputs, which are compared, are the same numbers everywhere.
        while count > 0 && self.time(count) > time + slack {
            count -= 1;
        }
        while self.time(count + 1) <= time + slack {
            count += 1;
        }
        count
    }

    /// The first output after `time`, or after the one that `time` is \[s\].
    fn beyond(self, time: f64) -> f64 {
        self.time(self.last(time, self.slack(time)) + 1)
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
        let [history, frames, checkpoints] = intervals.map(|interval| interval.map(Series::every));
        let named = history.or(frames).or(checkpoints).is_some();
        let plain = (!named).then(|| Series::every(end / DEFAULT_STEPS));
        Self { history, frames, checkpoints, plain, end }.until(end, scene, scene_name)
    }

    /// The same to another end \[s\], with the communication steps that a run to its own end has.
    pub(crate) fn until(self, end: f64, scene: &Scene, scene_name: &str) -> Result<Self, Refusal> {
        let kinds = [self.history, self.frames, self.checkpoints];
        for (series, (key, what, most)) in kinds.into_iter().zip(MOST) {
            let Some(Series { interval, .. }) = series else { continue };
            let count = end / interval;
            if count > most * (1.0 + SAME) {
                return Err(Refusal::Counts { scene: scene_name.to_owned(), key, interval, count, what, end, most });
            }
        }
        let schedule = Self { end, ..self };
        if let Step::Given(step) = scene.run.step {
            schedule.check_step(scene_name, step)?;
        }
        Ok(schedule)
    }

    /// Refuses a time step of which nobody can mean so many \[s\].
    pub(crate) fn check_step(&self, scene_name: &str, step: f64) -> Result<(), Refusal> {
        let count = self.end / step;
        if count <= MOST_STEPS {
            return Ok(());
        }
        Err(Refusal::Steps { scene: scene_name.to_owned(), step, count, end: self.end, most: MOST_STEPS })
    }

    /// All intervals.
    fn series(&self) -> impl Iterator<Item = Series> {
        [self.history, self.frames, self.checkpoints, self.plain].into_iter().flatten()
    }

    /// The first point after the one at `time` \[s\]; none at the end.
    pub(crate) fn after(&self, time: f64) -> Option<Point> {
        if time >= self.end {
            return None;
        }
        let mut next = self.series().map(|series| series.beyond(time)).fold(self.end, f64::min);
        if self.series().any(|series| self.end - next < series.slack(self.end)) {
            next = self.end;
        }
        let is_due = |series: Option<Series>| {
            series.is_some_and(|series| next >= self.end || series.beyond(time) - next < series.slack(next))
        };
        let due = Due {
            history: is_due(self.history) || next >= self.end,
            frame: is_due(self.frames),
            checkpoint: is_due(self.checkpoints) || next >= self.end,
        };
        let between = next - time;
        let is_whole = |interval: &f64| (between - interval).abs() <= ROUNDING * next;
        // As the scene has it, and a master that steps by it: the difference of two times differs from it by rounding.
        let interval = self.series().map(|series| series.interval).find(is_whole).unwrap_or(between);
        Some(Point { time: next, interval, due })
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

    /// Whether the scene names an interval.
    pub(crate) fn has_intervals(&self) -> bool {
        self.plain.is_none()
    }

    /// By how much the clock may differ from a communication point at this time in steps of this length \[s\]: steps that fit an
    /// interval but for rounding of the user's numbers are not divided.
    pub(crate) fn drift(&self, time: f64, step: f64) -> f64 {
        let shortest = self.series().map(|series| series.interval).fold(self.end, f64::min);
        SAME * shortest + ROUNDING * time + FITTING * step * (time / shortest)
    }

    /// Whether a row of the history is due at the point at `time` \[s\].
    pub(crate) fn has_row(&self, time: f64) -> bool {
        let is_regular =
            |series: Series| (series.time(series.last(time, series.slack(time))) - time).abs() <= series.slack(time);
        time >= self.end || self.history.map_or(time == 0.0, is_regular)
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
        let count = series.last(time, series.slack(time)) + 1;
        if count > 1 && self.end - series.time(count - 1) < series.slack(self.end) { count - 1 } else { count }
    }
}

/// When frames are due where the communication points come from outside: at the first point at or after each multiple of
/// the scene's interval, or at every point if the scene has none. Nothing is shortened for them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrameSchedule {
    /// The scene's interval.
    series: Option<Series>,
}

impl FrameSchedule {
    /// Those that a scene asks for.
    pub(crate) fn of(scene: &Scene) -> Self {
        Self { series: scene.output.frame_interval.map(Series::every) }
    }

    /// The frame that is due at a point \[s\] if the last one is this, with the time that it is known by; none if none is
    /// due. Times are since the start.
    pub(crate) fn due(&self, time: f64, last: Option<Frame>) -> Option<Frame> {
        let Some(series) = self.series else {
            let number = last.map_or(0, |last| last.number + 1);
            return last.is_none_or(|last| time > last.time).then_some(Frame { number, time });
        };
        let slack = ARRIVED * series.interval;
        let count = series.last(time, slack);
        let regular = series.time(count);
        let number = usize::try_from(count).unwrap_or(usize::MAX);
        let time = if (time - regular).abs() <= slack { regular } else { time };
        last.is_none_or(|last| number > last.number).then_some(Frame { number, time })
    }
}

#[cfg(test)]
mod tests;
