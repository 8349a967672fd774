//! Spectrum of the slip velocity at probe nodes, recorded at every step.

use super::caption::caption;
use super::scene::Scene;
use crate::PostError;
use crate::conditions::IN_CONTACT;
use crate::frames::open_history;
use figure::{Axis, Draw, Figure, Mark, Panel, Series, colour, thin};
use output::layout::{HISTORY, PROBE, of_probe};
use std::f64::consts::{PI, TAU};
use std::path::Path;

const COLOURS: [[u8; 3]; 6] =
    [colour::BLUE, colour::RED, colour::GREEN, colour::PURPLE, colour::ORANGE, colour::BLACK];

/// The spectra of the probes in the file at `path`; `None` where there is no file, or no probe was in contact for
/// more than 64 steps.
pub(super) fn spectrum(scene: &Scene<'_>, path: &Path) -> Result<Option<Figure>, PostError> {
    let Some(probes) = open_history(path)? else { return Ok(None) };
    let Some(time) = probes.column(&HISTORY.time)?.filter(|time| time.len() > 64) else {
        return Ok(None);
    };
    let dt = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let mut series = Vec::new();
    for k in 0.. {
        let column = |column| probes.column(&of_probe(k, column));
        let (Some(pressure), Some(slip)) =
            (column(&PROBE.pressure)?, column(&PROBE.slip_velocity_x)?)
        else {
            break;
        };
        let touches = |p: &f64| *p > IN_CONTACT * scene.scales.peak_pressure;
        let (Some(from), Some(to)) =
            (pressure.iter().position(touches), pressure.iter().rposition(touches))
        else {
            continue;
        };
        if to - from < 64 {
            continue;
        }
        let points = density(&slip[from..=to], dt);
        let points: Vec<_> = points.into_iter().map(|[f, power]| [1e-3 * f, power]).collect();
        series.push(Series {
            label: format!("probe {k}"),
            points: thin(&points, 600),
            draw: Draw::Line(COLOURS[k % COLOURS.len()]),
        });
    }
    if series.is_empty() {
        return Ok(None);
    }
    let mut marks = Vec::new();
    if let Some(speed) = scene.basis.scale("speed") {
        let x = 1e-3 * speed / scene.scales.size;
        marks.push(Mark { x, label: "V/h".into(), colour: colour::GREY });
    }
    if let Some(speed) = scene.scales.shear_wave {
        let x = 1e-3 * speed / scene.scales.size;
        marks.push(Mark { x, label: "c_s/h".into(), colour: colour::BLACK });
    }
    let panel = Panel {
        title: String::new(),
        x: Axis::log("frequency (kHz)"),
        y: Axis::log("power density of s_x (m\u{b2}/s\u{b2}/Hz)"),
        fill: None,
        series,
        marks,
    };
    let text = "Spectrum of the slip velocity along x at the probe nodes while they are in \
                contact, from every step (Welch, 1024 steps). V/h: nodes that meet; c_s/h: shear waves \
                over an element.";
    Ok(Some(Figure {
        size: [760, 500],
        columns: 1,
        panels: vec![panel],
        caption: caption(scene, text),
    }))
}

/// Steps per segment of a long record.
const SEGMENT: usize = 1024;

/// One-sided power spectral density of `values` less their mean, sampled every `dt` (s), as frequency (Hz) and
/// density (square of the unit of the values per Hz), without zero frequency. Mean over segments that overlap by
/// half, each under a Hann window (Welch 1967); fewer than two [`SEGMENT`]s of values are one segment.
fn density(values: &[f64], dt: f64) -> Vec<[f64; 2]> {
    let n = if values.len() >= 2 * SEGMENT { SEGMENT } else { values.len() };
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let size = n.next_power_of_two();
    let mut power = vec![0.0; size / 2];
    let mut count = 0.0;
    for segment in (0..=values.len() - n).step_by((n / 2).max(1)) {
        let mut wave = vec![[0.0; 2]; size];
        let mut squares = 0.0;
        for (i, value) in values[segment..segment + n].iter().enumerate() {
            let hann = 0.5 - 0.5 * libm::cos(TAU * i as f64 / n as f64);
            wave[i][0] = hann * (value - mean);
            squares += hann * hann;
        }
        transform(&mut wave);
        for (power, [re, im]) in power.iter_mut().zip(&wave) {
            *power += 2.0 * dt * (re * re + im * im) / squares;
        }
        count += 1.0;
    }
    let at = |k: usize| [k as f64 / (size as f64 * dt), power[k] / count];
    (1..size / 2).map(at).collect()
}

/// Fast Fourier transform in place (Cooley and Tukey 1965, radix 2); the length a power of two.
fn transform(wave: &mut [[f64; 2]]) {
    let n = wave.len();
    let mut j = 0;
    for i in 1..n {
        let mut bit = n >> 1;
        while j & bit != 0 {
            j ^= bit;
            bit >>= 1;
        }
        j |= bit;
        if i < j {
            wave.swap(i, j);
        }
    }
    let mut length = 2;
    while length <= n {
        for start in (0..n).step_by(length) {
            for k in 0..length / 2 {
                let (sin, cos) = libm::sincos(-2.0 * PI * k as f64 / length as f64);
                let [a, b] = [wave[start + k], wave[start + k + length / 2]];
                let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                wave[start + k] = [a[0] + turned[0], a[1] + turned[1]];
                wave[start + k + length / 2] = [a[0] - turned[0], a[1] - turned[1]];
            }
        }
        length *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_has_its_power_at_its_frequency() {
        let (dt, frequency, amplitude) = (1e-7, 1e6 / 1.024, 0.3);
        let values: Vec<f64> =
            (0..1024).map(|i| amplitude * libm::sin(TAU * frequency * dt * f64::from(i))).collect();
        let spectrum = density(&values, dt);
        let top = spectrum.iter().max_by(|a, b| a[1].total_cmp(&b[1])).map_or(0.0, |p| p[0]);
        assert!((top / frequency - 1.0).abs() < 1e-3, "{top}");
        // Parseval: the power is half the square of the amplitude
        let step = 1.0 / (1024.0 * dt);
        let power: f64 = spectrum.iter().map(|p| p[1] * step).sum();
        assert!((power / (0.5 * amplitude * amplitude) - 1.0).abs() < 1e-6, "{power}");
    }
}
