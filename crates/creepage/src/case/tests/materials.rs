//! What the materials of the two bodies change.

use super::set;
use crate::case::hertz::dundurs_beta;

#[test]
fn unlike_materials_have_dundurs_beta_and_are_told_that_creepage_0_is_not_free_rolling() {
    let warned = |sets: &[&str]| set(sets).unwrap().warnings().join("\n");
    // a polymer wheel on steel: beta by hand, with G = 1.0714 and 80.77 GPa
    let light = "load.normal=3000";
    let polymer = ["disk.material.young=3e9", "disk.material.poisson=0.4", light];
    let beta = dundurs_beta(&set(&polymer).unwrap());
    let [soft, hard]: [f64; 2] = [3e9 / 2.8, 210e9 / 2.6];
    let by_hand = 0.5 * (0.2 / soft - 0.4 / hard) / (0.6 / soft + 0.7 / hard);
    assert!((beta / by_hand - 1.0).abs() < 1e-12 && beta > 0.15, "{beta} {by_hand}");
    for words in ["Dundurs' beta 0.160", "creepage 0 is not free rolling", "drive.torque = 0"] {
        assert!(warned(&polymer).contains(words), "{words}: {}", warned(&polymer));
    }
    // the sign turns with the bodies
    let swapped = ["bar.material.young=3e9", "bar.material.poisson=0.4", light];
    assert!((dundurs_beta(&set(&swapped).unwrap()) + beta).abs() < 1e-15);
    // equal elastic constants, whatever the density and wherever they are given
    for alike in [
        &["material.young=3e9", light][..],
        &["disk.material.density=2700"],
        &["material.young=3e9", "disk.material.young=3e9", "bar.material.young=3e9", light],
    ] {
        assert!(!warned(alike).contains("Dundurs"), "{}", warned(alike));
    }
}
