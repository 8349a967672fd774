//! The progress bar, on a terminal only.

use std::io::IsTerminal;

use case::{Progress, Stage};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

const TICKS: u64 = 1000;

/// Watches a run: a bar on standard error where that is a terminal, silence elsewhere.
pub struct Watch {
    bar: ProgressBar,
    stage: Option<Stage>,
}

impl Watch {
    /// A watch that has seen nothing yet.
    pub fn new(quiet: bool) -> Self {
        let bar = ProgressBar::new(TICKS);
        let visible = !quiet && std::io::stderr().is_terminal();
        bar.set_draw_target(if visible {
            ProgressDrawTarget::stderr_with_hz(8)
        } else {
            ProgressDrawTarget::hidden()
        });
        Self { bar, stage: None }
    }

    /// Shows how far the run is.
    pub fn show(&mut self, progress: &Progress) {
        if self.bar.is_hidden() {
            return;
        }
        if self.stage != Some(progress.stage) {
            self.stage = Some(progress.stage);
            self.bar.set_style(style(progress.stage));
            // The time that is left is judged by the present stage alone.
            self.bar.reset();
        }
        let speed = progress.element_steps_per_s / 1e6;
        let normal = progress.normal_force / 1e3;
        let tangential = progress.tangential_force / 1e3;
        // What matters most first: a narrow terminal cuts the line.
        self.bar.set_message(match progress.stage {
            Stage::Mesh => String::new(),
            Stage::Preload => format!(
                "iteration {}, normal {normal:.2} kN, {speed:.1} M element-steps/s",
                progress.step
            ),
            Stage::Roll => format!(
                "{:.3}/{:.3} ms, N {normal:.1} T {tangential:.1} kN, {speed:.1} M element-steps/s",
                1e3 * progress.time,
                1e3 * progress.end_time,
            ),
        });
        let done = progress.step as f64 / progress.steps.max(1) as f64;
        self.bar.set_position((done * TICKS as f64) as u64);
    }

    /// Removes the bar.
    pub fn finish(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn style(stage: Stage) -> ProgressStyle {
    let template = match stage {
        Stage::Mesh => "mesh     {spinner}",
        Stage::Preload => "preload  {spinner} {elapsed}, {msg}",
        Stage::Roll => "rolling  {percent:>3}% {bar:12} {eta} left, {msg}",
    };
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
