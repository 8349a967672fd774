//! The progress bar, on a terminal only.

use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

use ::sweep::Watched;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use scenario::{Progress, Stage};

const TICKS: u64 = 1000;

/// How often a run tells the sweep that it belongs to how far it is.
const TOLD: Duration = Duration::from_millis(200);

/// Watches a run: a bar on standard error where that is a terminal, silence elsewhere. For a sweep
/// it also writes the share that is done to standard output, a number a line.
pub struct Watch {
    bar: ProgressBar,
    stage: Option<Stage>,
    told: Option<Instant>,
}

impl Watch {
    /// A watch that has seen nothing yet.
    pub fn new(quiet: bool, for_sweep: bool) -> Self {
        Self { bar: bar(quiet), stage: None, told: for_sweep.then(Instant::now) }
    }

    /// Shows how far the run is.
    pub fn show(&mut self, progress: &Progress) {
        if let Some(told) = self.told.as_mut().filter(|told| told.elapsed() >= TOLD)
            && progress.stage == Stage::Roll
        {
            *told = Instant::now();
            let done = progress.step as f64 / progress.steps.max(1) as f64;
            let mut out = std::io::stdout();
            // A sweep that is gone ends this run by another way.
            let _ = writeln!(out, "{done:.4}").and_then(|()| out.flush());
        }
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

/// Watches a sweep: a bar on standard error where that is a terminal, elsewhere a line for every
/// run that ends.
pub struct SweepWatch {
    bar: ProgressBar,
    /// Name of the sweep, and the runs done as of the last line.
    lines: Option<(String, usize)>,
    begun: Instant,
}

impl SweepWatch {
    /// A watch that has seen nothing yet.
    pub fn new(quiet: bool, name: &str) -> Self {
        let bar = bar(quiet);
        let lines = (bar.is_hidden() && !quiet).then(|| (name.to_owned(), 0));
        let template = "{percent:>3}% {bar:12} {elapsed}, {eta} left, {msg}";
        let style = ProgressStyle::with_template(template);
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, lines, begun: Instant::now() }
    }

    /// Shows how far the sweep is.
    pub fn show(&mut self, now: &Watched) {
        let failed =
            if now.failed > 0 { format!(", {} failed", now.failed) } else { String::new() };
        let (done, all) = (now.completed, now.runs);
        let said = format!("{done} of {all} runs done{failed}, {} running", now.running);
        if let Some((name, told)) = &mut self.lines
            && *told != done + now.failed
        {
            *told = done + now.failed;
            let left = self.begun.elapsed().as_secs_f64() * (1.0 / now.fraction - 1.0);
            let left =
                if left.is_finite() { format!(", about {left:.0} s left") } else { "".into() };
            // A closed standard error must not end the sweep.
            let _ = writeln!(std::io::stderr(), "{name}: {said}{left}");
        }
        self.bar.set_message(said);
        self.bar.set_position((now.fraction * TICKS as f64) as u64);
    }

    /// Removes the bar.
    pub fn finish(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn bar(quiet: bool) -> ProgressBar {
    let bar = ProgressBar::new(TICKS);
    let visible = !quiet && std::io::stderr().is_terminal();
    bar.set_draw_target(if visible {
        ProgressDrawTarget::stderr_with_hz(8)
    } else {
        ProgressDrawTarget::hidden()
    });
    bar
}

fn style(stage: Stage) -> ProgressStyle {
    let template = match stage {
        Stage::Mesh => "mesh     {spinner}",
        Stage::Preload => "preload  {spinner} {elapsed}, {msg}",
        Stage::Roll => "rolling  {percent:>3}% {bar:12} {eta} left, {msg}",
    };
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
