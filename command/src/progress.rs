//! How far a command is: a bar in a terminal, a line now and then elsewhere, nothing where it is to be quiet.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Parts of a progress bar.
const BAR_LENGTH: u64 = 10_000;

/// Time between two drawings of a progress bar while nothing is told.
const BAR_PAUSE: Duration = Duration::from_millis(500);

/// Time between two lines.
const LINE_PAUSE: Duration = Duration::from_secs(30);

/// Time before another line where a tenth of the way has been gone meanwhile.
const LEAST_LINE_PAUSE: Duration = Duration::from_secs(1);

/// Part of the way for which there is a line.
const LINE_SHARE: f64 = 0.1;

/// Shows how far a command is, on the standard error.
pub(super) enum Progress {
    /// It is to be quiet.
    Quiet,
    /// A bar in a terminal.
    Bar(ProgressBar),
    /// Lines, in a pipe or a file.
    Lines {
        /// When the work began.
        begun: Instant,
        /// When the last line was written.
        last: Instant,
        /// Share of the way that was gone then.
        share: f64,
    },
}

impl Progress {
    /// Shows a bar of this template where that can be.
    pub(super) fn new(quiet: bool, template: &str) -> Self {
        if quiet {
            return Self::Quiet;
        }
        if !std::io::stderr().is_terminal() {
            let now = Instant::now();
            return Self::Lines { begun: now, last: now, share: 0.0 };
        }
        let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::new(BAR_LENGTH).with_style(style);
        bar.enable_steady_tick(BAR_PAUSE);
        Self::Bar(bar)
    }

    /// Tells how far the work is, in words, and which share of the way has been gone, where that is known.
    pub(super) fn tell(&mut self, share: Option<f64>, words: impl FnOnce() -> String) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => {
                if let Some(share) = share {
                    bar.set_position((share * BAR_LENGTH as f64) as u64);
                }
                bar.set_message(words());
            }
            Self::Lines { begun, last, share: before } => {
                let gone = share.unwrap_or(0.0);
                let waited = last.elapsed();
                if waited < LINE_PAUSE && (waited < LEAST_LINE_PAUSE || gone < *before + LINE_SHARE) {
                    return;
                }
                (*last, *before) = (Instant::now(), gone);
                let left = begun.elapsed().as_secs_f64() * (1.0 - gone) / gone;
                let end = match share {
                    Some(_) if left.is_finite() => {
                        format!(" ({:.0} %), about {} left", 100.0 * gone, cograin::words::duration(left))
                    }
                    _ => String::new(),
                };
                // Who closed the standard error does not want to know.
                let _ = writeln!(std::io::stderr(), "{}{end}", super::printable(&words()));
            }
        }
    }

    /// Takes the bar away.
    pub(super) fn end(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}
