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
    let read = |text: &str| inp_cases(text, folder.path(), None);
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
        ("  1 MODULE", "  5 MODULE", "line 2: MODULE = 5"),
        (" 0 MODULE", " 1 MODULE", "the file ends"),
    ] {
        let error = read(&WHEEL.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(error.contains(words), "{words}: {error}");
    }
}

/// Of CONTACT's examples (Apache-2.0): tractcurv.inp, case 1 and what case 2 has in place of it, and fastsim.inp, cases 1 and 2.
const BASIC: &str = "
 3 MODULE
  203100     P-B-T-N-F-S        PVTIME, BOUND , TANG  , NORM , FORCE, STRESS
  022020     L-D-C-M-Z-E        FRCLAW, DISCNS, INFLCF, MATER, RZNORM, EXRHS
 0000341   H-G-I-A-O-W-R  HEAT, GAUSEI, IESTIM, MATFIL, OUTPUT, FLOW, RETURN
    80   200    5    1      1e-6    MAXGS , MAXIN , MAXNR , MAXOUT, EPS
 106700.      0.00001    0.000      0.000           FN, CKSI, CETA, CPHI
   0.330      0.330                                 FSTAT, FKIN
   0.000      0.500      10000.                     CHI, DQ, VELOC
   0.280      0.280      82000.     82000.          POISS 1,2,  GG 1,2
   -2                                               IPOTCN
   48   44    0.0008     0.500      1.100           MX,MY,A1,AOB,SCALE
 3 MODULE
  203100     P-B-T-N-F-S
  100000     L-D-C-M-Z-E
 0100341   H-G-I-A-O-W-R
 106700.      0.0004     0.000      0.000           FN, CKSI, CETA, CPHI
 3 MODULE
  203100     P-B-T-N-F-S
  022020     L-D-C-M-Z-E
 0101341   H-G-I-A-O-W-R
   82000.     0.000     -0.000625   0.000625        FN, CKSI, CETA, CPHI
   0.300      0.300                                 FSTAT, FKIN
   0.000      0.400      30000.                     CHI, DQ, VELOC
   0.280      0.280      82000.     82000.          POISS 1,2,  GG 1,2
   -3                                               IPOTCN
   44   44     8.000      4.000      1.100          MX,MY,AA,BB,SCALE
 3 MODULE
  233100     P-B-T-N-F-S
  122320     L-D-C-M-Z-E
 0100341   H-G-I-A-O-W-R
";

fn basic(text: &str, wanted: usize) -> Result<InpCase, InpError> {
    Ok(inp_cases(text, Path::new(""), Some(wanted))?.remove(0))
}

/// Half axes of the patch (mm).
fn half_axes(case: &InpCase) -> [f64; 2] {
    let case = crate::case::Case::from_text(&case.text, Path::new("x.toml"), &[]).unwrap();
    assert!(case.is_half_space() && !case.has_inertia());
    let patch = crate::case::hertz::hertz(&case);
    [1e3 * patch.a, 1e3 * patch.b]
}

fn near(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}

#[test]
fn two_bodies_have_the_patch_that_contact_prints_and_its_creepage() {
    for (number, axes, creepage) in
        [(1, [6.304, 12.61], -1e-5), (2, [6.304, 12.61], -4e-4), (3, [8.0, 4.0], 0.0)]
    {
        let case = basic(BASIC, number).unwrap();
        half_axes(&case).iter().zip(axes).for_each(|(found, axis)| near(*found, axis));
        assert_eq!(value(&case, "drive.creepage"), creepage);
    }
    let [first, spun] = [1, 3].map(|number| basic(BASIC, number).unwrap());
    near(value(&first, "disk.radius"), 0.625);
    near(value(&first, "mesh.zone.size"), 0.2889e-3);
    near(value(&first, "material.young"), 2.56 * 82e9);
    assert_eq!(value(&first, "friction.static"), 0.33);
    assert_eq!(value(&spun, "drive.lateral_creepage"), -6.25e-4);
    near(value(&spun, "drive.spin"), 0.625);
    near(value(&spun, "mesh.zone.size"), 0.2e-3);
    // half axes that are given stay under another force
    let text = BASIC.replacen("   -2 ", "   -3 ", 1).replacen("0.0008     0.500", "8.0 4.0", 1);
    let text = text.replacen(" 106700.      0.0004", " 50000. 0.0004", 1);
    half_axes(&basic(&text, 2).unwrap()).iter().zip([8.0, 4.0]).for_each(|(a, b)| near(*a, b));
}

#[test]
fn two_bodies_of_given_curvatures_are_driven_by_a_force() {
    const SQUARES: &str = "0.3 0.25 MX,MY,XL,YL,DX,DY\n 1 1 IBASE, IPLAN\n";
    for (kind, grid) in [
        ("-1", "48 44 0.0008 0.002 1.1".to_owned()),
        ("1", format!("48 44 -7 -7 {SQUARES} .0008 0 .002 0 0 0")),
        ("3", format!("48 44 -6.9 -6.9 {SQUARES} .0008 0 .002\n 0 0 0 B4,B5,B6")),
    ] {
        let text = BASIC.replacen("  203100 ", "  203110 ", 1).replacen("0.00001", "0.6", 1);
        let text = text.replacen("   -2 ", kind, 1).replacen(
            "48   44    0.0008     0.500      1.100",
            &grid,
            1,
        );
        let case = basic(&text, 1).unwrap();
        near(value(&case, "disk.radius"), 0.625);
        near(value(&case, "bar.crown_radius"), 0.25);
        near(value(&case, "drive.torque"), 0.6 * 0.33 * 106.7e3 * 0.625);
        if kind != "-1" {
            near(value(&case, "mesh.zone.size"), 0.25e-3);
        }
        half_axes(&case);
    }
}

#[test]
fn what_two_half_spaces_cannot_say_is_refused_by_its_name_and_line() {
    for (from, to, words) in [
        ("  203100 ", "  202100 ", "line 3: TANG = 2"),
        ("  203100 ", "  203000 ", "line 3: NORM = 0"),
        ("  203100 ", "  203120 ", "line 3: FORCE = 2"),
        ("  022020 ", "  422020 ", "line 4: FRCLAW = 4"),
        ("  022020 ", "  022120 ", "line 4: MATER = 1"),
        ("  022020 ", " 3022020 ", "line 4: VARFRC = 3"),
        ("  022020 ", "  022029 ", "line 4: EXRHS = 9"),
        (" 0000341 ", " 3000341 ", "line 5: HEAT = 3"),
        ("106700.      0.00001", "106700. x", "line 7: 'x' must be CKSI"),
        ("106700.      0.00001", "0 0.00001", "line 7: FN, VELOC"),
        ("0.000           FN", "0.000 0 1 FN", "line 7: SPINYO = 1"),
        ("0.330      0.330 ", "0.330 0.300 ", "line 8: FKIN = 0.3"),
        ("0.000      0.500", "90d 0.5", "line 9: CHI = 1.57"),
        ("   -2  ", "   -4  ", "line 11: IPOTCN = -4"),
        ("   48   44  ", "   48   1  ", "line 12: MY = 1"),
    ] {
        let error = basic(&BASIC.replacen(from, to, 1), 1).unwrap_err().to_string();
        assert!(error.contains(words), "{words}: {error}");
    }
    let error = basic(BASIC, 4).unwrap_err().to_string();
    assert!(error.contains("line 29: BOUND = 3"), "{error}");
}
