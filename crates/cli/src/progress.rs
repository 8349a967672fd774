//! What the terminal shows of a command under way: remarks, and a bar where it is a terminal.

use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use creepage::run::progress_lines::{self, ProgressLines};
use creepage::{Cost, Listener, Progress, Stage, Watched};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};

use crate::args::Args;
use crate::report::layout::{about, count, digits};
use crate::stop::WRITING;

const TICKS: u64 = 1000;

/// Says the remarks of a command, and leaves Ctrl-C to end it at once.
pub struct Remarks<'a>(pub &'a Args);

impl Listener for Remarks<'_> {
    fn remark(&mut self, line: &str) {
        self.0.say(line);
    }
}

/// Watches a run: a bar on standard error where that is a terminal, a line every minute elsewhere.
pub struct RunWatch<'a> {
    args: &'a Args,
    bar: ProgressBar,
    lines: ProgressLines,
    stage: Option<Stage>,
}

impl<'a> RunWatch<'a> {
    /// A watch that has seen nothing yet.
    pub fn new(args: &'a Args) -> Self {
        let bar = bar(args.quiet, of_stage(Stage::Mesh));
        let lines = ProgressLines::new(progress_lines::INTERVAL, Instant::now());
        Self { args, bar, lines, stage: None }
    }
}

impl Listener for RunWatch<'_> {
    fn stop(&mut self) -> Arc<AtomicBool> {
        self.args.stop.in_order(WRITING)
    }

    fn remark(&mut self, line: &str) {
        self.args.say(line);
    }

    fn run(&mut self, progress: &Progress) {
        if progress.stage == Stage::Roll {
            self.args.stop.hears();
        }
        if let Some(cost) = &progress.cost {
            let said = cost_line(cost);
            self.bar.suspend(|| self.args.say(&said));
        }
        if self.bar.is_hidden() {
            let line = self.lines.due(progress, Instant::now());
            line.iter().for_each(|line| self.args.say(line));
            return;
        }
        if self.stage != Some(progress.stage) {
            self.stage = Some(progress.stage);
            self.bar.set_style(style(of_stage(progress.stage)));
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
}

/// What a run will take, in a line.
fn cost_line(cost: &Cost) -> String {
    let about_or_less = if cost.seconds < 0.5 { "" } else { "about " };
    format!(
        "{} elements, {} steps of {} ns: {about_or_less}{} on this machine, {} MB of results",
        count(Some(cost.elements as f64)),
        count(Some(cost.steps as f64)),
        digits(Some(1e9 * cost.dt), 4),
        about(Some(cost.seconds)),
        digits(Some(1e-6 * cost.disk), 3),
    )
}

/// Watches a sweep: a bar on standard error where that is a terminal, elsewhere a line for every
/// run that ends.
pub struct SweepWatch<'a> {
    args: &'a Args,
    bar: ProgressBar,
    /// Runs done as of the last line.
    reported: usize,
    begun: Option<Instant>,
}

impl<'a> SweepWatch<'a> {
    /// A watch that has seen nothing yet.
    pub fn new(args: &'a Args) -> Self {
        let template = "{percent:>3}% {bar:12} {elapsed}, {eta} left, {msg}";
        Self { args, bar: bar(args.quiet, template), reported: 0, begun: None }
    }
}

impl Listener for SweepWatch<'_> {
    fn stop(&mut self) -> Arc<AtomicBool> {
        self.args.stop.in_order(WRITING)
    }

    fn remark(&mut self, line: &str) {
        self.bar.suspend(|| self.args.say(line));
    }

    fn sweep(&mut self, name: &str, now: &Watched) {
        // its runs end in order, each in its own time
        self.args.stop.hears();
        let begun = *self.begun.get_or_insert_with(|| {
            self.bar.reset();
            Instant::now()
        });
        let failed =
            if now.failed > 0 { format!(", {} failed", now.failed) } else { String::new() };
        let (done, all) = (now.completed, now.runs);
        let said = format!("{done} of {all} runs done{failed}, {} running", now.running);
        if self.bar.is_hidden() && self.reported != done + now.failed {
            self.reported = done + now.failed;
            let left = begun.elapsed().as_secs_f64() * (1.0 / now.fraction - 1.0);
            let left =
                if left.is_finite() { format!(", about {left:.0} s left") } else { "".into() };
            self.args.say(&format!("{name}: {said}{left}"));
        }
        self.bar.set_message(said);
        self.bar.set_position((now.fraction * TICKS as f64) as u64);
    }
}

/// Watches the slider: a bar on standard error where that is a terminal.
pub struct SliderWatch<'a> {
    args: &'a Args,
    bar: ProgressBar,
}

impl<'a> SliderWatch<'a> {
    /// A watch that has seen nothing yet.
    pub fn new(args: &'a Args) -> Self {
        Self { args, bar: bar(args.quiet, "slider  {percent:>3}% {bar:12} {eta} left") }
    }
}

impl Listener for SliderWatch<'_> {
    fn stop(&mut self) -> Arc<AtomicBool> {
        self.args.stop.in_order(WRITING)
    }

    fn remark(&mut self, line: &str) {
        self.args.say(line);
    }

    fn slider(&mut self, step: u64, steps: u64) {
        self.bar.set_length(steps);
        self.bar.set_position(step);
        if step == steps {
            self.bar.finish_and_clear();
        }
    }
}

/// A bar that is gone when it is dropped.
fn bar(quiet: bool, template: &str) -> ProgressBar {
    let visible = !quiet && std::io::stderr().is_terminal();
    let target =
        if visible { ProgressDrawTarget::stderr_with_hz(8) } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(TICKS), target);
    bar.with_finish(ProgressFinish::AndClear).with_style(style(template))
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// How far a run is, by its stage.
fn of_stage(stage: Stage) -> &'static str {
    match stage {
        Stage::Mesh => "mesh     {spinner}",
        Stage::Preload => "preload  {spinner} {elapsed}, {msg}",
        Stage::Roll => "rolling  {percent:>3}% {bar:12} {eta} left, {msg}",
    }
}
