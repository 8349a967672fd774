use super::*;
use std::path::Path;

fn value(case: &InpCase, key: &str) -> f64 {
    let table: toml::Table = toml::from_str(&case.text).unwrap();
    let mut at = &toml::Value::Table(table);
    for part in key.split('.') {
        at = at.get(part).unwrap();
    }
    at.as_float().unwrap()
}

/// Case 7 of examples/mbench_a22_left.inp (CONTACT, Apache-2.0) alone, on profiles of arcs.
const WHEEL: &str = "
  1 MODULE
 1203100    C-P-B-T-N-F-S   CONFIG, PVTIME, BOUND,  TANG,   NORM,   FORCE,  STRESS
 0022033    V-L-D-C-M-Z-E   VARFRC, FRCLAW, DISCNS, INFLCF, MATER,  ZTRACK, EWHEEL
 0000321    H-G-I-A-O-W-R     HEAT, GAUSEI, IESTIM, MATFIL, OUTPUT, FLOW,   RETURN
    999     100    30    1     1e-5         MAXGS , MAXIN , MAXNR , MAXOUT, EPS
  0.300   0.300                                 FSTAT, FKIN
  0.280   0.280   82000.  82000.                POISS 1,2,  GG 1,2
  0.200   0.200   1.000   90d   8.0   4.0       DX,DS, DQREL, A_SEP, D_SEP, D_COMB
   14.0     0    1435.0   0.000                GAUGHT, GAUGSQ, GAUGWD, CANT
  'rail.prr'   0     1.0   0.0       RFNAME, MIRRORY, SCALE, SMOOTH
     0.0    0.0   0.000   0.0   0.0   0.000     DY, DZ, ROLL, VY, VZ, VROLL
  1360.0  -70.0   460.0                         FBDIST, FBPOS, NOMRAD
  'wheel.prw'   0     1.0   0.0       WFNAME, MIRRORY, SCALE, SMOOTH
  0.0  3.0  10000. -0.00018030 0.0072  0.0      S, Y, FZ, ROLL, YAW, PITCH
 2000. 0.0    0.0   0.0        0.0  -4.34515030 VS,VY,VZ, VROLL,VYAW,VPITCH
 0 MODULE
";

#[test]
fn a_wheel_on_a_rail_keeps_its_position_and_its_creepage() {
    let folder = tempfile::tempdir().unwrap();
    let points = |profile: &mesh::profile::Profile, [low, high]: [f64; 2]| -> String {
        let at = |i: i32| low + (high - low) * f64::from(i) / 600.0;
        let line = |i: i32| format!("{} {}\n", 1e3 * at(i), 1e3 * profile.at(at(i)).unwrap()[0]);
        (0..=600).map(line).collect()
    };
    let (rail, wheel) = (mesh::profile::rail_60e1(), mesh::profile::wheel_s1002());
    std::fs::write(folder.path().join("rail.prr"), points(&rail, [-0.0365, 0.0365])).unwrap();
    std::fs::write(folder.path().join("wheel.prw"), points(&wheel, [-0.06, 0.06])).unwrap();
    let read = |text: &str| inp_cases(text, folder.path());
    // the second case keeps all but its position
    let two = WHEEL.replace(
        " 0 MODULE",
        " 1 MODULE\n 1203100\n 0111002\n 0100321\n 0.0 4.0 10000. -0.0002557 0.0096 0.0\n 2000. 0 0 0 0 -4.344093\n 0 MODULE",
    );
    let cases = read(&two).unwrap();
    assert_eq!(cases.iter().map(|case| case.number).collect::<Vec<_>>(), [1, 2]);
    assert_eq!(value(&cases[1], "disk.yaw"), 0.0096);
    assert_eq!(value(&cases[1], "friction.static"), 0.3);
    let case = &cases[0];
    assert!((value(case, "drive.creepage") - (4.3451503 * 0.46 / 2.0 - 1.0)).abs() < 1e-12);
    assert_eq!(value(case, "disk.yaw"), 0.0072);
    assert_eq!(value(case, "disk.roll"), 0.0001803);
    // the wheels are 1500 mm apart, the rails' gauge points 1435 mm: at 14 mm depth 35.98 mm from the apex
    let lateral = value(case, "disk.lateral");
    let expected = 0.750 * libm::cos(0.0072) * libm::cos(0.0001803) + 3e-3 - (0.7175 + 0.03598);
    assert!((lateral - expected).abs() < 0.02e-3, "{lateral} {expected}");
    let case = crate::case::Case::from_text(&case.text, Path::new("x.toml"), &[]).unwrap();
    let point = case.wheel_on_rail().unwrap().unwrap().first_contact().unwrap();
    assert!(point.angle > 0.0 && point.rolling_radius > 0.46);
    for (from, to, words) in [
        (" 2000. 0.0 ", " 2000. 5.0 ", "line 16: VY_WS = 5"),
        ("   14.0     0 ", "   14.0     1 ", "line 10: GAUGSQ = 1"),
        ("'rail.prr'   0 ", "'rail.prr'   1 ", "line 11: MIRRORY = 1"),
        (" 1203100 ", " 5203100 ", "line 3: CONFIG = 5"),
        (" 0022033 ", " 0042033 ", "line 4: DISCNS = 4"),
        (" 1203100 ", " 1202100 ", "line 3: TANG = 2"),
        (" 0022033 ", " 0422033 ", "line 4: FRCLAW = 4"),
        (" 0000321 ", " 3000321 ", "line 5: HEAT = 3"),
        ("0.300   0.300", "0.300   0.280", "line 7: FKIN = 0.28"),
        ("82000.  82000.", "82000.  26000.", "line 8: GG2 = 26000"),
        (" 0.200   0.200", " 0.200   x", "line 9: 'x' must be DS"),
        ("  1 MODULE", "  3 MODULE", "line 2: MODULE = 3"),
        (" 0 MODULE", " 1 MODULE", "the file ends"),
    ] {
        let error = read(&WHEEL.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(error.contains(words), "{words}: {error}");
    }
}
