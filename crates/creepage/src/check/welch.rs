//! Power spectral density of a series.

use std::f64::consts::{PI, TAU};

/// Values per segment of a long record.
const SEGMENT: usize = 1024;

/// One-sided power spectral density of `values` less their mean, sampled every `dt` (s, or m), as frequency (Hz, or
/// 1/m) and density (square of the unit of the values over that of the frequency), without zero frequency. Mean over segments that overlap by
/// half, each under a Hann window (Welch 1967); fewer than two [`SEGMENT`]s of values are one segment.
pub(crate) fn density(values: &[f64], dt: f64) -> Vec<[f64; 2]> {
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

    #[test]
    fn a_long_record_has_the_density_of_one_of_its_segments() {
        let (dt, frequency) = (1e-7, 1e6 / 1.024);
        let wave = |count: i32| -> Vec<f64> {
            (0..count).map(|i| libm::sin(TAU * frequency * dt * f64::from(i))).collect()
        };
        let [one, many] = [SEGMENT as i32, 8 * SEGMENT as i32].map(|n| density(&wave(n), dt));
        let top = one.iter().fold(0.0, |top: f64, p| top.max(p[1]));
        assert_eq!(one.len(), many.len());
        for (a, b) in one.iter().zip(&many) {
            assert!(a[0] == b[0] && (a[1] - b[1]).abs() < 1e-9 * top, "{a:?} {b:?}");
        }
    }
}
