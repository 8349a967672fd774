use super::*;
use std::path::Path;

/// Case 1 of examples/tractcurv.inp (CONTACT, Apache-2.0), with the half axes in the place of a curvature, and one that keeps all but
/// its creepage.
const BASIC: &str = "
 3 MODULE   % two bodies
  203100     P-B-T-N-F-S        PVTIME, BOUND , TANG  , NORM , FORCE, STRESS
  022020     L-D-C-M-Z-E        FRCLAW, DISCNS, INFLCF, MATER, RZNORM, EXRHS
 0000341   H-G-I-A-O-W-R  HEAT, GAUSEI, IESTIM, MATFIL, OUTPUT, FLOW, RETURN
    80   200    5    1      1e-6    MAXGS , MAXIN , MAXNR , MAXOUT, EPS
 106700.      0.00001    0.001      0.0002           FN, CKSI, CETA, CPHI
   0.330      0.330                                 FSTAT, FKIN
   0.000      0.500      10000.                     CHI, DQ, VELOC
   0.280      0.280      82000.     82000.          POISS 1,2,  GG 1,2
   -1                                               IPOTCN
   48   44    0.0008     0.002      1.100           MX,MY,A1,B1,SCALE

 3 MODULE
  203100     P-B-T-N-F-S
  100000     L-D-C-M-Z-E
 0100341   H-G-I-A-O-W-R
 106700.      0.0004     0.000      0.000           FN, CKSI, CETA, CPHI
 0 MODULE
";

fn read(text: &str) -> Result<Vec<InpCase>, InpError> {
    inp_cases(text, Path::new("."))
}

fn value(case: &InpCase, key: &str) -> f64 {
    let table: toml::Table = toml::from_str(&case.text).unwrap();
    let mut at = &toml::Value::Table(table);
    for part in key.split('.') {
        at = at.get(part).unwrap();
    }
    at.as_float().unwrap()
}

#[test]
fn a_basic_case_becomes_two_bodies_and_the_next_keeps_what_it_does_not_say() {
    let cases = read(BASIC).unwrap();
    assert_eq!(cases.iter().map(|case| case.number).collect::<Vec<_>>(), [1, 2]);
    for case in &cases {
        assert!((value(case, "disk.radius") - 0.625).abs() < 1e-12);
        assert!((value(case, "bar.crown_radius") - 0.25).abs() < 1e-12);
        assert_eq!(value(case, "friction.static"), 0.33);
        assert_eq!(value(case, "drive.speed"), 10.0);
        assert!((value(case, "material.young") / (2.56 * 82e9) - 1.0).abs() < 1e-12);
    }
    assert_eq!(value(&cases[0], "drive.creepage"), -1e-5);
    assert_eq!(value(&cases[0], "drive.lateral_creepage"), 1e-3);
    assert!((value(&cases[0], "drive.spin") - 0.2).abs() < 1e-12);
    assert_eq!(value(&cases[1], "drive.creepage"), -4e-4);
    let again = crate::case::Case::from_text(&cases[0].text, Path::new("x.toml"), &[]).unwrap();
    assert!(again.is_half_space() && !again.has_inertia());
}

#[test]
fn what_half_spaces_cannot_say_is_refused_by_its_name_and_line() {
    for (from, to, words) in [
        ("  203100     P-B-T-N-F-S        P", "  202100 ", "line 3: TANG = 2"),
        ("  022020     L-D-C-M-Z-E        F", "  422020 ", "line 4: FRCLAW = 4"),
        ("  022020     L-D-C-M-Z-E        F", "  022120 ", "line 4: MATER = 1"),
        (" 0000341   H-G-I-A-O-W-R  H", " 3000341 ", "line 5: HEAT = 3"),
        ("0.330      0.330 ", "0.330 0.300 ", "line 8: FKIN = 0.3"),
        ("82000.     82000.", "82000. 26000.", "line 10: GG2 = 26000"),
        ("0.000      0.500      10000.", "1.57 0.5 10000.", "line 9: CHI = 1.57"),
        ("   -1      ", "   -6      ", "line 11: IPOTCN"),
        ("106700.      0.00001", "106700. x", "line 7: 'x' must be CKSI"),
        (" 3 MODULE   %", " 5 MODULE %", "line 2: MODULE = 5"),
    ] {
        let text = BASIC.replacen(from, to, 1);
        assert_ne!(text, BASIC, "{from}");
        let error = read(&text).unwrap_err().to_string();
        assert!(error.contains(words), "{words}: {error}");
    }
    assert!(read("1 MODULE\n").unwrap_err().to_string().contains("the file ends"));
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
    std::fs::write(folder.path().join("rail.prr"), points(&rail, [-0.0359, 0.0359])).unwrap();
    std::fs::write(folder.path().join("wheel.prw"), points(&wheel, [-0.06, 0.06])).unwrap();
    let read = |text: &str| inp_cases(text, folder.path());
    let cases = read(WHEEL).unwrap();
    let case = &cases[0];
    assert!((value(case, "drive.creepage") - (4.3451503 * 0.46 / 2.0 - 1.0)).abs() < 1e-12);
    assert_eq!(value(case, "disk.yaw"), 0.0072);
    assert_eq!(value(case, "disk.roll"), 0.0001803);
    // the wheels are 1500 mm apart, the rails' gauge points at 14 mm depth 1435 mm: 36 mm from the apex
    let lateral = value(case, "disk.lateral");
    let expected = 0.750 * libm::cos(0.0072) * libm::cos(0.0001803) + 3e-3 - (0.7175 + 0.036);
    assert!((lateral - expected).abs() < 0.02e-3, "{lateral} {expected}");
    let case = crate::case::Case::from_text(&case.text, Path::new("x.toml"), &[]).unwrap();
    let point = case.wheel_on_rail().unwrap().unwrap().first_contact().unwrap();
    assert!(point.angle > 0.0 && point.rolling_radius > 0.46);
    for (from, to, words) in [
        (" 2000. 0.0 ", " 2000. 5.0 ", "line 17: VY_WS = 5"),
        ("   14.0     0 ", "   14.0     1 ", "line 10: GAUGSQ = 1"),
        ("'rail.prr'   0 ", "'rail.prr'   1 ", "line 11: MIRRORY = 1"),
        (" 1203100 ", " 5203100 ", "line 3: CONFIG = 5"),
        (" 0022033 ", " 0042033 ", "line 4: DISCNS = 4"),
    ] {
        let error = read(&WHEEL.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(error.contains(words), "{words}: {error}");
    }
}
