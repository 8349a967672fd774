//! How far a run is, in lines for those who see no bar.

use std::time::{Duration, Instant};

use crate::scenario::progress::{Progress, Stage};

/// Wall time between two lines.
pub const INTERVAL: Duration = Duration::from_secs(60);

/// Lines that say how far a run is, each an interval of wall time after the one before.
pub struct ProgressLines {
    interval: Duration,
    last: Instant,
    begun: Option<Begun>,
}

/// The stage under way, as this process first saw it.
#[derive(Clone, Copy)]
struct Begun {
    stage: Stage,
    at: Instant,
    step: u64,
}

impl ProgressLines {
    /// Of a run that begins `now`.
    pub fn new(interval: Duration, now: Instant) -> Self {
        Self { interval, last: now, begun: None }
    }

    /// The line of a run that is this far, if one is due `now`.
    pub fn due(&mut self, progress: &Progress, now: Instant) -> Option<String> {
        let seen = Begun { stage: progress.stage, at: now, step: progress.step };
        let begun = *self
            .begun
            .insert(self.begun.filter(|begun| begun.stage == seen.stage).unwrap_or(seen));
        if now.duration_since(self.last) < self.interval {
            return None;
        }
        let line = line(progress, begun, now.duration_since(begun.at))?;
        self.last = now;
        Some(line)
    }
}

/// What is known of a stage that took this `time` so far; nothing of a mesh that is made.
fn line(progress: &Progress, begun: Begun, time: Duration) -> Option<String> {
    let Progress { step, steps, .. } = *progress;
    let [normal, tangential] = [progress.normal_force, progress.tangential_force].map(|f| 1e-3 * f);
    match progress.stage {
        Stage::Mesh => None,
        // how many iterations there will be is not known
        Stage::Preload => Some(format!(
            "preload: iteration {step}, N {normal:.2} kN, {} so far",
            in_seconds(time.as_secs_f64())
        )),
        Stage::Roll => {
            let per_step = time.as_secs_f64() / step.saturating_sub(begun.step) as f64;
            let left = per_step * steps.saturating_sub(step) as f64;
            let left = if left.is_finite() { in_seconds(left) } else { "an unknown time".into() };
            Some(format!(
                "step {step} of {steps}, {:.4} of {:.4} ms, N {normal:.2} kN, T {tangential:.2} kN, {left} left",
                1e3 * progress.time,
                1e3 * progress.end_time
            ))
        }
    }
}

/// Days, hours, minutes and whole seconds.
fn in_seconds(time: f64) -> String {
    humantime::format_duration(Duration::from_secs(time.round() as u64)).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rolling(step: u64) -> Progress {
        Progress {
            stage: Stage::Roll,
            step,
            steps: 48_000,
            time: 1e-7 * step as f64,
            end_time: 4.8e-3,
            normal_force: 100_340.0,
            tangential_force: 26_100.0,
            element_steps_per_s: 1e7,
            cost: None,
        }
    }

    fn preload(step: u64) -> Progress {
        Progress { stage: Stage::Preload, steps: 500, ..rolling(step) }
    }

    /// What is said, and when (s), of a run that is seen at these times (s).
    fn said(seen: &[(u64, Progress)]) -> Vec<(u64, String)> {
        let begin = Instant::now();
        let mut lines = ProgressLines::new(INTERVAL, begin);
        let at = |time: u64| begin + Duration::from_secs(time);
        seen.iter()
            .filter_map(|(time, progress)| Some((*time, lines.due(progress, at(*time))?)))
            .collect()
    }

    #[test]
    fn a_run_says_each_minute_how_far_it_is() {
        // 100 steps a second
        let seen: Vec<_> = (0..=150).map(|time| (time, rolling(100 * time))).collect();
        let of = |step: u64, ms: &str, left: &str| {
            format!("step {step} of 48000, {ms} of 4.8000 ms, N 100.34 kN, T 26.10 kN, {left} left")
        };
        let wanted = [(60, of(6000, "0.6000", "7m")), (120, of(12_000, "1.2000", "6m"))];
        assert_eq!(said(&seen), wanted);
        assert_eq!(said(&seen[..60]), []);
    }

    #[test]
    fn the_time_left_is_judged_by_the_steps_of_this_process() {
        // a run that goes on from step 24000, 100 steps a second
        let seen = [0, 60].map(|time| (time, rolling(24_000 + 100 * time)));
        assert!(said(&seen)[0].1.ends_with(", 3m left"));
        let unknown = said(&[(60, rolling(24_000))]);
        assert!(unknown[0].1.ends_with(", an unknown time left"));
    }

    #[test]
    fn a_preload_tells_its_iteration_and_a_mesh_nothing() {
        let mesh = Progress { stage: Stage::Mesh, ..rolling(0) };
        let seen = [(0, mesh), (70, mesh), (80, preload(1)), (150, preload(7))];
        let first = (80, "preload: iteration 1, N 100.34 kN, 0s so far".to_owned());
        let second = (150, "preload: iteration 7, N 100.34 kN, 1m 10s so far".to_owned());
        assert_eq!(said(&seen), [first, second]);
    }
}
