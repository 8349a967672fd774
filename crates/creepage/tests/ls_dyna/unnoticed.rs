//! Nothing of a model is lost unnoticed: every field of a card is used, at its default or refused, and every card is
//! counted.

use std::fs;
use std::path::Path;

use creepage::case::Case;
use creepage::case::schema::{Creepage, LoadMode, Stiffness};
use creepage::ls_dyna::{DeckError, Fault, Source, Translation, Units, translate};

/// The small model of `meshes/`: a disk of radius 100 mm on a bar, 2000 N, 16 m/s, until 2.5e-4 s.
const DECK: &str = include_str!("../../../../meshes/small.k");

fn translated(deck: &[u8], units: &str) -> Result<Translation, DeckError> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("small.k");
    fs::write(&file, deck).unwrap();
    let source = Source { file: &file, include_outside: false };
    translate(&source, Units::parse(units).unwrap(), "mesh.inp")
}

fn import(deck: &str) -> Result<Translation, DeckError> {
    translated(deck.as_bytes(), "mm-ton-s")
}

#[track_caller]
fn case(deck: &str) -> Case {
    let made = import(deck).unwrap_or_else(|error| panic!("{error}"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    fs::write(&path, &made.case).unwrap();
    fs::write(folder.path().join("mesh.inp"), &made.mesh).unwrap();
    Case::load(&path, &[]).unwrap_or_else(|error| panic!("{error}\n{}", made.case))
}

/// The deck with a text in place of another, which stands there.
#[track_caller]
fn changed(old: &str, new: &str) -> String {
    let text = DECK.replacen(old, new, 1);
    assert_ne!(text, DECK, "{old}");
    text
}

/// The deck with further cards in front of `*END`.
fn with(cards: &str) -> String {
    changed("*END", &format!("{cards}\n*END"))
}

#[track_caller]
fn refused(deck: &str, words: &str) -> DeckError {
    let error = import(deck).map(|_| ()).expect_err(words);
    assert!(error.to_string().contains(words), "{words}: {error}");
    error
}

/// The line that begins so, counted from 1.
#[track_caller]
fn line(deck: &str, begins: &str) -> Option<usize> {
    Some(1 + deck.lines().position(|line| line.starts_with(begins)).expect(begins))
}

/// A prescribed motion of the hub and its curve, of number 7.
fn moved(dof: u32, points: &[[f64; 2]]) -> String {
    let mut cards = format!(
        "*BOUNDARY_PRESCRIBED_MOTION_RIGID\n{:>10}{dof:>10}{:>10}{:>10}{:>10}\n*DEFINE_CURVE\n{:>10}\n",
        3, 0, 7, 1.0, 7
    );
    for [t, value] in points {
        cards += &format!("{t:>20e}{value:>20e}\n");
    }
    with(cards.trim_end())
}

const LOAD_POINTS: &str =
    "                 0.0                 1.0\n                 1.0                 1.0\n";
const SPIN: &str = "         1         2    160.32   16000.0";
const AXIS: &str = "       0.0       0.0     100.0       0.0       1.0       0.0";

#[test]
fn a_curve_counts_where_the_run_ends() {
    for (points, load) in [
        // zero after the end
        ("0.0,1.0\n5.0e-4,1.0\n6.0e-4,0.0\n", 2000.0),
        // half as much at the end as later
        ("0.0,0.5\n5.0e-4,0.5\n6.0e-4,1.0\n", 1000.0),
        // it rises first, and is whole at half of the run
        ("0.0,0.0\n1.25e-4,0.25\n1.0,0.25\n", 500.0),
    ] {
        let found = case(&changed(LOAD_POINTS, points)).load.normal;
        assert!((found / load - 1.0).abs() < 1e-5, "{points}: {found}");
    }
    let fast = moved(1, &[[0.0, 16000.0], [2.5e-4, 16000.0], [1e-2, 32000.0]]);
    assert_eq!(case(&fast).drive.speed, 16.0);
    let turn = case(&moved(6, &[[0.0, 160.0], [2.5e-4, 160.32], [1.0, 200.0]]).replacen(
        SPIN,
        "         1         2     160.0   16000.0",
        1,
    ));
    assert!(
        (turn.drive.creepage.as_ref().and_then(Creepage::number).unwrap() - 2e-3).abs() < 1e-9,
        "{:?}",
        turn.drive.creepage
    );
    assert_eq!(turn.drive.ramp(), 2.5e-4);
    // between two points: 160 + 8 (2.5e-4/1e-2), where free rolling is at 160
    let between = moved(6, &[[0.0, 160.0], [1e-2, 168.0]]).replacen("160.32", " 160.0", 1);
    let creepage = case(&between).drive.creepage.as_ref().and_then(Creepage::number).unwrap();
    assert!((creepage - 0.2 / 160.0).abs() < 1e-9, "{creepage}");
    let notes = import(&between).unwrap().notes;
    assert!(notes.iter().any(|note| note.contains("curve 7 changes beyond ENDTIM")), "{notes:?}");
}

#[test]
fn a_curve_is_scaled_and_shifted_as_its_card_says() {
    // times 1e-3 (a + 0.1), values 2 (o + 0.25): 1.5 from 1e-4 s on, 0 before it
    let head = "         1\n";
    let scaled = "         1         0    1.0e-3       2.0       0.1      0.25\n";
    let deck = changed(&format!("*DEFINE_CURVE\n{head}"), &format!("*DEFINE_CURVE\n{scaled}"));
    let deck = deck.replacen(LOAD_POINTS, "0.0,0.5\n1.0,0.5\n", 1);
    let found = case(&deck).load.normal;
    assert!((found / 3000.0 - 1.0).abs() < 1e-5, "{found}");
}

#[test]
fn curves_that_a_case_cannot_say_are_refused() {
    let load = |points: &str| changed(LOAD_POINTS, points);
    let fast = |points: &[[f64; 2]]| moved(1, points);
    for (deck, words) in [
        (
            load("0.0,0.0\n1.0,1.0\n"),
            "a load that still changes at ENDTIM, where its curve 1 is at 2.5e-4",
        ),
        (load("0.0,0.0\n2.5e-4,1.0\n1.0,1.0\n"), "a load that still changes at ENDTIM"),
        (load("0.0,1.0\n1.0e-4,0.5\n1.0,0.5\n"), "a load that falls again"),
        (
            load("0.0,1.0\n2.0e-4,1.0\n"),
            "curve 1, whose points do not reach from 0 to ENDTIM = 2.5e-4",
        ),
        (load("1.0e-4,1.0\n1.0,1.0\n"), "curve 1, whose points do not reach"),
        (load("0.0,1.0\n3.0e-4,1.0\n2.0e-4,1.0\n"), "the time 2e-4 of a curve is before"),
        (fast(&[[0.0, 0.0], [1e-4, 16e3], [1.0, 16e3]]), "changes to 16000 while the disk rolls"),
        (fast(&[[0.0, 32e3], [1.0, 32e3]]), "of 32000 beside an initial velocity VX = 16000"),
        (moved(6, &[[0.0, 0.0], [1e-4, 160.0], [1.0, 160.0]]), "does not go from 160.32 to 160"),
        (
            moved(6, &[[0.0, 160.32], [1e-4, 170.0], [2e-4, 165.0], [1.0, 165.0]]),
            "does not go from",
        ),
        (moved(5, &[[0.0, 0.0], [1.0, 1.0]]), "turns about DOF = 5"),
    ] {
        let error = refused(&deck, words);
        assert!(error.place.is_some(), "{words}");
    }
}

#[test]
fn a_load_that_rises_while_the_disk_rolls_is_noted() {
    let notes = import(&changed(LOAD_POINTS, "0.0,0.0\n1.0e-4,1.0\n1.0,1.0\n")).unwrap().notes;
    assert!(
        notes.iter().any(|note| note.contains("the load of curve 1 rises for 1.000e-4 s")),
        "{notes:?}"
    );
    let nodes = changed("         1         3         1 -13", "         2         3         1 -13");
    refused(&nodes, "of the hub, which does not exist");
}

#[test]
fn a_motion_that_ends_hands_over_to_a_load_or_is_refused() {
    let turn = "*BOUNDARY_PRESCRIBED_MOTION_RIGID\n3,6,0,1,160.32,0,";
    let torque = "\n*LOAD_RIGID_BODY\n3,6,1,5.0";
    refused(&with(&format!("{turn}1.0e-4")), "DOF = 6 with DEATH = 1e-4");
    refused(&with(&format!("{turn}1.0e-4{torque}")), "DOF = 6 with DEATH = 1e-4");
    refused(&with(&format!("{turn}0{torque}")), "a torque on a hub whose turn is prescribed");
    refused(&with(&format!("{torque}{torque}")), "a second torque");
    let depth = "*BOUNDARY_PRESCRIBED_MOTION_RIGID\n3,3,2,1,-0.01,0,";
    refused(&with(&format!("{depth}1.0e-4")), "DOF = 3 with DEATH = 1e-4");
    let held = case(&with(&format!("{depth}1.0")));
    assert_eq!(held.load.mode, LoadMode::Height);
}

#[test]
fn a_disk_that_rolls_late_rests_until_then() {
    let late = "*INITIAL_VELOCITY_GENERATION_START_TIME\n    1.0e-4\n*END";
    let deck = moved(1, &[[0.0, 16e3], [1.0, 16e3]]).replacen("*END", late, 1);
    refused(&deck, "DOF = 1 before the disk begins to roll");
    let rests = moved(1, &[[0.0, 0.0], [1e-4, 0.0], [1.0001e-4, 16e3], [1.0, 16e3]]);
    let found = case(&rests.replacen("*END", late, 1));
    assert_eq!((found.drive.speed, found.time.duration), (16.0, Some(1.5e-4)));
}

#[test]
fn the_disk_turns_about_its_axle_or_is_refused() {
    let about = |axis: &str| changed(AXIS, axis);
    for axis in [
        // the rail; beside the axle; a millimetre above it
        "       0.0       0.0       0.0       0.0       1.0       0.0",
        "      50.0       0.0     100.0       0.0       1.0       0.0",
        "       0.0       0.0     101.0       0.0       1.0       0.0",
    ] {
        let deck = about(axis);
        let error = refused(&deck, "off the axle at 0, 100");
        assert_eq!(error.place.unwrap().line, line(&deck, axis).unwrap());
    }
    // where along the axle does not matter
    let along = about("       0.0      33.0     100.0       0.0       1.0       0.0");
    assert_eq!(case(&along).drive.speed, 16.0);
    for axis in ["       1.0       0.0       0.0", "       0.0       0.0       0.0"] {
        let deck = about(&format!("       0.0       0.0     100.0{axis}"));
        refused(&deck, "about the axis NX, NY, NZ");
    }
}

#[test]
fn an_initial_velocity_of_nodes_of_the_bar_of_all_or_of_none_is_refused() {
    let start = DECK.find("*INITIAL_VELOCITY_GENERATION").unwrap();
    let end = start + DECK[start..].find("*NODE").unwrap();
    let velocity = |set: u64| {
        let card = format!("*INITIAL_VELOCITY\n{set:>10}         0         0\n   16000.0\n");
        DECK.replacen(&DECK[start..end], &card, 1)
    };
    refused(&velocity(2), "*INITIAL_VELOCITY of others than the whole disk");
    refused(&velocity(0), "*INITIAL_VELOCITY of others than the whole disk");
    refused(&velocity(1), "*INITIAL_VELOCITY of others than the whole disk");
    refused(&velocity(77), "node set 77, which does not exist");
    // all nodes of the disk, which part 1 has
    let mut nodes: Vec<&str> = DECK[DECK.find("*ELEMENT_SOLID\n").unwrap()..]
        .lines()
        .skip(1)
        .take_while(|line| !line.starts_with('*'))
        .filter(|line| line[8..16].trim() == "1")
        .flat_map(|line| (16..80).step_by(8).map(|at| line[at..at + 8].trim()))
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    let set: String = nodes.chunks(8).map(|line| line.join(",") + "\n").collect();
    let deck = velocity(50).replacen("*END", &format!("*SET_NODE_LIST\n50\n{set}*END"), 1);
    assert_eq!(case(&deck).drive.speed, 16.0);
}

/// Fields that no case takes: text of the deck, the same with 7 in the field for `#`, and what the refusal says.
const FIELDS: [(&str, &str, &str); 50] = [
    ("       0.0      0.67", "       #0      0.67", "*CONTROL_TIMESTEP with DTINIT = 70"),
    ("      0.67\n", "      0.67         0         0         #\n", "DT2MS = 7"),
    ("      0.67\n", "      0.67\n         0         0         #\n", "IMSCL = 7"),
    ("    2.5e-4\n", "    2.5e-4         #\n", "*CONTROL_TERMINATION with ENDCYC = 7"),
    ("    2.5e-4\n", "    2.5e-4         0       0.#\n", "DTMIN = 0.7"),
    (
        "       1.0\n*CONTROL_E",
        "       1.0       0.0         1         0         #\n*CONTROL_E",
        "PENOPT = 7",
    ),
    (
        "       1.0\n*CONTROL_E",
        "       1.0\n\n       0.#\n*CONTROL_E",
        "*CONTROL_CONTACT with SFRIC = 0.7",
    ),
    ("       1.0\n*CONTROL_E", "       1.0\n\n\n         #\n*CONTROL_E", "IGNORE = 7"),
    (
        "         1         1\n*MAT",
        "         1         1         #\n*MAT",
        "*SECTION_SOLID with AET = 7",
    ),
    ("   2.1e+05       0.3", "   2.1e+05       0.3       0.#", "*MAT_ELASTIC with DA = 0.7"),
    ("   2.1e+05       0.3", "   2.1e+05       0.3       0.0       0.#", "DB = 0.7"),
    ("      0.05         1       1.5", "      0.05         #       1.5", "*HOURGLASS with IBQ = 7"),
    (
        "         1         1         1         0         1\n",
        "         1         1         1         #         1\n",
        "*PART with EOSID = 7",
    ),
    (
        "         1         1         1         0         1\n",
        "         1         1         1         0         1         #\n",
        "GRAV = 7",
    ),
    (
        "       101       102         0         0\n",
        "       101       102         0         0         #\n",
        "SBOXID = 7",
    ),
    (
        "    0.0060       0.0      10.0\n",
        "    0.0060       0.0      10.0         #\n",
        "PENCHK = 7",
    ),
    (
        "    0.0060       0.0      10.0\n",
        "    0.0060       0.0      10.0         0       0.#\n",
        "BT = 0.7",
    ),
    (
        "    0.0060       0.0      10.0\n",
        "    0.0060       0.0      10.0         0       0.0    #.0e-5\n",
        "DT = 7e-5",
    ),
    (
        "       0.5      0.32",
        "       2.0        #.",
        "FS = 2, which stands for friction by a table",
    ),
    (
        "       0.5      0.32",
        "      -1.0        #.",
        "FS = -1, which stands for friction by a table",
    ),
    ("       1.0       1.0\n*CONS", "       1.0       1.0       0.#\n*CONS", "SST = 0.7"),
    (
        "       1.0       1.0\n*CONS",
        "       1.0       1.0       0.0       0.0       1.0       1.0       0.#\n*CONS",
        "FSF = 0.7",
    ),
    ("       1.0       1.0\n*CONS", "       1.0       1.0\n         #\n*CONS", "SOFT = 7"),
    (
        "       1.0       1.0\n*CONS",
        "       1.0       1.0\n         0       0.1         #\n*CONS",
        "LCIDAB = 7",
    ),
    ("       1.0       1.0\n*CONS", "       1.0       1.0\n\n       0.#\n*CONS", "PENMAX = 0.7"),
    (
        "       1.0       1.0\n*CONS",
        "       1.0       1.0\n\n\n         1         #\n*CONS",
        "IGNORE = 7",
    ),
    (
        "       1.0       1.0\n*CONS",
        "       1.0       1.0\n\n\n\n\n\n\n\n\n         #\n*CONS",
        "data line 11 of *CONTACT_SURFACE_TO_SURFACE",
    ),
    (
        "         3         0         1\n",
        "         3         #         1\n",
        "*CONSTRAINED_NODAL_RIGID_BODY with CID = 7",
    ),
    (
        "         3         0         1\n",
        "         3         0         1         0         0         #\n",
        "DRFLAG = 7",
    ),
    (
        "         2         0         1         1         1\n",
        "         2         #         1         1         1\n",
        "DOFX, DOFY, DOFZ",
    ),
    (
        "         3         1 -13.88889\n",
        "         3         1 -13.88889         #\n",
        "*LOAD_NODE_SET with CID = 7",
    ),
    (
        "         3         1 -13.88889\n",
        "         3         1 -13.88889         0         #\n",
        "M1 = 7",
    ),
    (
        "*DEFINE_CURVE\n         1\n",
        "*DEFINE_CURVE\n         1         #\n",
        "*DEFINE_CURVE with SIDR = 7",
    ),
    ("*DEFINE_CURVE\n         1\n", "*DEFINE_CURVE\n1,,,,,,#\n", "DATTYP = 7"),
    (
        "    160.32   16000.0\n",
        "    160.32   16000.0       #.0\n",
        "*INITIAL_VELOCITY_GENERATION with VY = 7",
    ),
    ("    160.32   16000.0\n", "    160.32   16000.0       0.0       0.0         #\n", "IVATN = 7"),
    (AXIS, "       0.0       0.0     100.0       0.0       1.0       0.0         #", "PHASE = 7"),
    (
        AXIS,
        "       0.0       0.0     100.0       0.0       1.0       0.0         0         #",
        "IRIGID = 7",
    ),
    ("       0.719136\n", "       0.719136       #\n", "*NODE with TC = 7"),
    ("*SET_SEGMENT\n       101\n", "*SET_SEGMENT\n101,0,0,#\n", "*SET_SEGMENT with DA3 = 7"),
    ("*SET_SEGMENT\n       101\n", "*SET_SEGMENT\n101,0,0,0,0,#\n", "SOLVER = 7"),
    ("*SET_NODE_LIST\n         1\n", "*SET_NODE_LIST\n1,0,0,0,0,MECH,#\n", "ITS = 7"),
    ("*END", "*BOUNDARY_PRESCRIBED_MOTION_RIGID\n3,1,0,1,1.0,#\n*END", "VID = 7"),
    (
        "*END",
        "*BOUNDARY_PRESCRIBED_MOTION_RIGID\n3,1,0,1,16000.0,0,1e28,#e-5\n*END",
        "BIRTH = 7e-5",
    ),
    (
        "*END",
        "*BOUNDARY_PRESCRIBED_MOTION_RIGID\n3,1,0,1,16000.0,0,#e-5\n*END",
        "DOF = 1 with DEATH = 7e-5",
    ),
    ("*END", "*BOUNDARY_NON_REFLECTING\n102,#\n*END", "AD = 7"),
    ("*END", "*BOUNDARY_NON_REFLECTING\n102,0,#\n*END", "AS = 7"),
    ("*END", "*DAMPING_GLOBAL\n1,0.0,#.0\n*END", "STX = 7"),
    ("*END", "*DATABASE_BINARY_D3PLOT\n1e-5,0,0,#\n*END", "NPLTC = 7"),
    ("*END", "*CONTROL_BULK_VISCOSITY\n1.5,0.06,#\n*END", "TYPE = 7"),
];

#[test]
fn a_field_that_no_case_takes_is_refused_by_name_and_line() {
    for (old, new, words) in FIELDS {
        let with_field = changed(old, &new.replace('#', "7"));
        let error = refused(&with_field, words);
        let at = error.place.unwrap().line;
        let text = with_field.lines().nth(at - 1).unwrap();
        assert!(text.contains('7'), "{words}: line {at} is {text}");
    }
}

#[test]
fn fields_at_their_defaults_are_read_as_if_they_were_blank() {
    let plain = import(DECK).unwrap();
    for (old, new) in [
        (
            "      0.67\n",
            "      0.67         0       0.0       0.0         0         0         0\n       0.0         0         0                           0.0\n",
        ),
        ("    2.5e-4\n", "    2.5e-4         0       0.0       0.0 1.00000E8         0\n"),
        (
            "       1.0\n*CONTROL_E",
            "1.0,0.0,1,0,1,0,1,0\n0,0,10,0,4.0,0,0,0\n0,0,0,0,0,1,1,1.0\n0,0,0,0,0,0,0.5\n0,0,1,0,1.0,0,0,0\n*CONTROL_E",
        ),
        (
            "       1.0       1.0\n*CONS",
            "1.0,1.0,0.0,0.0,1.0,1.0,1.0,1.0\n0,0.1,0,1.025,2.0,2,0,1\n0,0,0,0,0,0,0,0\n1,0,0,0,0,,0,0\n0,0,0,0,0,0,0,0\n0,0,0,0,1.0,0,0,0\n0,0,,2.0,0,0,0,0\n*CONS",
        ),
        (
            "    0.0060       0.0      10.0\n",
            "    0.0060       0.0      10.0         0       0.01.00000E20\n",
        ),
        ("   2.1e+05       0.3", "   2.1e+05       0.3       0.0       0.0         0"),
        ("*SET_SEGMENT\n       101\n", "*SET_SEGMENT\n101,0.0,0.0,0.0,0.0,MECH,1\n"),
    ] {
        let made = import(&changed(old, new)).unwrap_or_else(|error| panic!("{new}: {error}"));
        assert_eq!(made, plain, "{new}");
    }
}

#[test]
fn a_second_thing_of_one_number_does_not_take_the_place_of_the_first() {
    for (cards, words) in [
        ("*CONTROL_TERMINATION\n1.0", "a second *CONTROL_TERMINATION"),
        ("*CONTROL_CONTACT\n0.5", "a second *CONTROL_CONTACT"),
        ("*MAT_ELASTIC\n1,1e-9,1e5,0.3", "a second material 1"),
        ("*SECTION_SOLID\n1,2", "a second section 1"),
        ("*HOURGLASS\n1,4,0.1", "a second hourglass control 1"),
        ("*PART\nwheel\n1,1,1,0,1", "a second part 1"),
        ("*DEFINE_CURVE\n1\n0.0,2.0\n1.0,2.0", "a second curve 1"),
        ("*SET_NODE_LIST\n1\n1,2", "a second node set 1"),
        ("*SET_SEGMENT\n101\n1,2,3,4", "a second segment set 101"),
    ] {
        let deck = with(cards);
        let error = refused(&deck, words);
        assert!(matches!(error.fault, Fault::Second { .. }), "{error:?}");
        assert!(error.place.unwrap().line > 7000, "the second is refused");
    }
}

#[test]
fn damping_of_parts_alone_is_refused_and_of_all_is_read() {
    let of = |cards: &str| with(&format!("*DAMPING_PART_STIFFNESS\n{cards}"));
    refused(&of("2,-1.0e-8"), "*DAMPING_PART_STIFFNESS of part 2 that part 1 lacks");
    refused(&of("1,-1.0e-8\n2,-2.0e-8"), "*DAMPING_PART_STIFFNESS of part 1 that part 2 lacks");
    assert_eq!(case(&of("1,-1.0e-8\n2,-1.0e-8")).kelvin_voigt(), 1e-8);
    refused(&of("1,-1.0e-8\n2,-1.0e-8\n9,-1.0e-8"), "part 9 of disk and bar, which does not exist");
    let relative = |psid: u32, pidrb: u32| {
        let cards = format!("*DAMPING_RELATIVE\n1.0,1000.0,{pidrb},{psid}\n*SET_PART_LIST\n5\n1");
        with(&format!("{cards}\n*SET_PART_LIST\n6\n1,2"))
    };
    refused(&relative(6, 3), "*DAMPING_RELATIVE of PSID 6");
    refused(&relative(5, 2), "PID 2, which is not the hub's, 3");
    let mass = case(&relative(5, 3)).damping.mass;
    assert!((mass - 4000.0 * std::f64::consts::PI).abs() < 0.1, "{mass}");
}

#[test]
fn a_keyword_that_does_not_begin_in_column_1_is_refused() {
    for before in [" ", "\t", "  ", "\u{a0}", "\u{feff}"] {
        let deck = changed("*CONTROL_CONTACT", &format!("{before}*CONTROL_CONTACT"));
        let error = refused(&deck, "`*CONTROL_CONTACT`, a keyword that does not begin in column 1");
        assert_eq!(error.place.unwrap().line, 10, "{before:?}");
        let deck =
            changed("*SECTION_SOLID", &format!("{before}*LOAD_BODY_Z\n1,9810.0\n*SECTION_SOLID"));
        refused(&deck, "*LOAD_BODY_Z");
    }
    // behind the asterisk blanks are none of the keyword
    assert_eq!(
        import(&changed("*CONTROL_CONTACT", "* control_contact  ")).unwrap(),
        import(DECK).unwrap()
    );
}

#[test]
fn lines_that_belong_to_no_card_are_refused() {
    for (old, new, words) in [
        ("    2.5e-4\n", "    2.5e-4\nLOAD_BODY_Z\n", "data line 2 of *CONTROL_TERMINATION"),
        ("*KEYWORD\n", "*KEYWORD\n1,2,3\n", "data line 1 of *KEYWORD"),
        ("a small disk on a bar\n", "a small disk on a bar\nof steel\n", "data line 2 of *TITLE"),
        ("*KEYWORD\n", "*KEYWORD IMPLICIT\n", "*KEYWORD with IMPLICIT"),
        ("*NODE\n", "*NODE_TITLE\n", "*NODE_TITLE is not read"),
        ("*CONTROL_ENERGY", "*CONTROL_START", "*CONTROL_START is not read"),
        (
            "*CONTROL_ENERGY",
            "*CONTROL_STEADY_STATE_ROLLING",
            "*CONTROL_STEADY_STATE_ROLLING is not",
        ),
    ] {
        refused(&changed(old, new), words);
    }
    let after = format!("{DECK}*LOAD_BODY_Z\n1,9810.0\n");
    let notes = import(&after).unwrap().notes;
    assert!(notes.iter().any(|note| note.contains("follows *END is not read")), "{notes:?}");
}

#[test]
fn what_stands_beyond_the_columns_of_a_line_is_a_remark() {
    let plain = import(DECK).unwrap();
    let part = "         1         1         1         0         1\n";
    let pad = |line: &str| format!("{:<80}", line.trim_end());
    for remark in ["section, material of the wheel", "2 mm, more or less", "$ steel"] {
        let deck = changed(part, &format!("{}{remark}\n", pad(part)));
        assert_eq!(import(&deck).unwrap(), plain, "{remark}");
    }
    let commas = format!("{}steel, rolled\n", pad("1,1,1,0,1"));
    assert_eq!(import(&changed(part, &commas)).unwrap(), plain);
    // numbers there are no remark: they stand between commas, or a column cuts through one
    for line in [format!("{},0,0,7\n", pad("1,1,1,0,1")), format!("{}7\n", "1".repeat(80))] {
        refused(&changed(part, &line), "numbers go on past column 80");
    }
    refused(&changed(part, &part.replace('\n', "         0  of steel\n")), "of steel");
    refused(&changed(part, &part.replace("         1", "\t1")), "a tab between columns");
    // the long format has 160 columns
    let material =
        "$      MID        RO         E        PR\n         1    7.8e-9   2.1e+05       0.3";
    let long = "*MAT_ELASTIC+\n                   1              7.8e-9              2.1e+5                 0.3";
    let long = format!("{long:<174}steel, rolled");
    assert_eq!(import(&changed(&format!("*MAT_ELASTIC\n{material}"), &long)).unwrap(), plain);
}

#[test]
fn a_deck_is_read_in_any_8_bit_encoding_and_utf_16_is_named() {
    let plain = import(DECK).unwrap();
    let read = |bytes: &[u8]| translated(bytes, "mm-ton-s");
    let marked = [b"\xef\xbb\xbf", DECK.as_bytes()].concat();
    assert_eq!(read(&marked).unwrap(), plain);
    let latin = DECK.replacen("\ndisk\n", "\nR#der\n", 1).replace('#', "\u{1}").into_bytes();
    let latin: Vec<u8> = latin.into_iter().map(|b| if b == 1 { 0xe4 } else { b }).collect();
    assert_eq!(read(&latin).unwrap(), plain);
    for ends in ["\r\n", "\r"] {
        let deck = DECK.replace('\n', ends);
        let made = read(deck.as_bytes()).unwrap();
        assert_eq!((made.case, made.mesh), (plain.case.clone(), plain.mesh.clone()), "{ends:?}");
    }
    let wide = |order: fn(u16) -> [u8; 2], mark: bool| -> Vec<u8> {
        let text = if mark { format!("\u{feff}{DECK}") } else { DECK.to_owned() };
        text.encode_utf16().flat_map(order).collect()
    };
    for mark in [true, false] {
        for order in [u16::to_le_bytes, u16::to_be_bytes] {
            let error = read(&wide(order, mark)).unwrap_err();
            assert!(error.to_string().contains("text in UTF-16"), "{error}");
        }
    }
}

#[test]
fn included_files_may_begin_with_a_byte_order_mark() {
    let folder = tempfile::tempdir().unwrap();
    let (head, nodes) = DECK.split_once("*NODE\n").unwrap();
    fs::write(folder.path().join("main.k"), format!("\u{feff}{head}*INCLUDE\nnodes.k\n*END\n"))
        .unwrap();
    fs::write(folder.path().join("nodes.k"), format!("\u{feff}*NODE\n{nodes}")).unwrap();
    let file = folder.path().join("main.k");
    let source = Source { file: &file, include_outside: false };
    let made = translate(&source, Units::parse("mm-ton-s").unwrap(), "mesh.inp").unwrap();
    assert_eq!(made.mesh, import(DECK).unwrap().mesh);
}

#[test]
fn every_card_of_a_deck_is_counted() {
    let keywords = |text: &str| {
        text.lines().filter(|line| line.starts_with('*') && !line.starts_with("*END")).count()
    };
    let cards = import(DECK).unwrap().cards;
    assert_eq!((cards.used, cards.ignored, cards.refused), (21, 2, 0));
    assert_eq!(keywords(DECK), 23);
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    for (deck, files, used, ignored) in [
        ("parts.k", &["parts.k"][..], 26, 7),
        ("long.k", &["long.k"], 22, 7),
        (
            "split/main.k",
            &[
                "split/main.k",
                "split/loads.k",
                "split/mesh/bodies.k",
                "split/mesh/nodes_of_bodies.k",
            ],
            29,
            7,
        ),
    ] {
        let file = fixtures.join(deck);
        let source = Source { file: &file, include_outside: false };
        let cards = translate(&source, Units::parse("mm-ton-s").unwrap(), "m.inp").unwrap().cards;
        assert_eq!((cards.used, cards.ignored, cards.refused), (used, ignored, 0), "{deck}");
        let read = |file: &&str| fs::read_to_string(fixtures.join(file)).unwrap();
        let all: usize = files.iter().map(|file| keywords(&read(file))).sum();
        assert_eq!(used + ignored, all, "{deck}");
    }
}

#[test]
fn all_cards_that_are_refused_are_told_together() {
    let deck =
        changed("*TITLE", "*MAT_RIGID\n1,1,1,1\n*TITLE").replace("*END", "*LOAD_BODY_Z\n1\n*END");
    let error = refused(&deck, "*MAT_RIGID is not read (the first of 2 cards that are refused)");
    assert_eq!(error.others.len(), 1);
    assert!(error.others[0].to_string().contains("*LOAD_BODY_Z is not read"), "{error:?}");
}

#[test]
fn units_that_do_not_fit_are_named_first_with_those_that_do() {
    for units in
        ["m-kg-s", "mm-kg-ms", "mm-kg-s", "cm-g-us", "mm-g-ms", "m-ton-s", "in-kg-s", "mm-ton-ms"]
    {
        let error = translated(DECK.as_bytes(), units).unwrap_err();
        let said = error.to_string();
        assert!(said.contains(&format!("--unit {units} is not that of the deck")), "{said}");
        assert!(
            error.fault.remedy().starts_with("give --unit mm-ton-s (density 7800"),
            "{}",
            error.fault.remedy()
        );
    }
    let named = |units: &str| with(&format!("*CONTROL_UNITS\n{units}"));
    assert_eq!(import(&named("mm,sec,mtrc_ton")).unwrap().case, import(DECK).unwrap().case);
    refused(&named("mm,ms,kg"), "its *CONTROL_UNITS names mm-kg-ms");
    refused(&named("ft,sec,slug"), "*CONTROL_UNITS with ft,sec,slug");
}

/// The deck with the coordinates of its nodes turned.
fn turned(turn: fn([f64; 3]) -> [f64; 3]) -> String {
    let turned = |line: &str| {
        let at = |i: usize| line[8 + 16 * i..24 + 16 * i].trim().parse().unwrap();
        let [x, y, z] = turn([at(0), at(1), at(2)]);
        format!("{}{x:16.6}{y:16.6}{z:16.6}\n", &line[..8])
    };
    DECK.lines().map(|l| if l.len() == 56 { turned(l) } else { format!("{l}\n") }).collect()
}

#[test]
fn a_model_in_another_frame_is_refused_for_its_axes() {
    for (deck, axis) in [
        (turned(|[x, y, z]| [x, z, -y]), "its vertical axis is y (the disk lies in +y of the bar"),
        (turned(|[x, y, z]| [z, y, -x]), "its vertical axis is x (the disk lies in +x of the bar"),
        (
            turned(|[x, y, z]| [x, -y, -z]),
            "its vertical axis is -z (the disk lies in -z of the bar",
        ),
        (turned(|[x, y, z]| [y, -x, z]), "its axle lies along x (the disk lies in +z of the bar"),
    ] {
        let error = refused(&deck, axis);
        assert!(error.to_string().contains("*LOAD_NODE_SET acts along z"), "{error}");
        assert!(error.fault.remedy().contains("z points up"), "{}", error.fault.remedy());
    }
    // with its load and its axis turned as well
    let up = turned(|[x, y, z]| [x, z, -y]);
    let up = up.replacen(
        "         1         3         1 -13.88889",
        "         1         2         1 -13.88889",
        1,
    );
    let up = up.replacen(AXIS, "       0.0     100.0       0.0       0.0       0.0      -1.0", 1);
    refused(&up, "*LOAD_NODE_SET acts along y, the disk turns about the axis (0, 0, -1)");
}

#[test]
fn no_bytes_make_the_reader_panic() {
    let seed = include_bytes!("../../../../fuzz/corpus/keywords/parts");
    // a linear congruential generator: the same bytes in every run
    let mut state = 1u64;
    let mut next = |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let pieces: [&[u8]; 8] = [b"*", b"\n", b",", b"\xff", b"&", b"\xef\xbb\xbf", b"-1e300", b"\0"];
    for _ in 0..3000 {
        let mut bytes = seed.to_vec();
        for _ in 0..1 + next(6) {
            let (at, piece) = (next(bytes.len()), pieces[next(pieces.len())]);
            let end = bytes.len().min(at + next(12));
            bytes.splice(at..end, piece.iter().copied());
        }
        let _ = translated(&bytes, "mm-ton-s");
    }
    assert!(matches!(case(DECK).contact.penalty.normal, Stiffness::Factor(_)));
}
