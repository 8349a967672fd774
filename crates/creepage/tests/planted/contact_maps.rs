//! Maps of the patch: what is drawn where, the border of contact, and the direction of arrows.
use crate::planted;
use crate::planted::{COULOMB, H, Leave, NX, NY, Node, OPEN, P0, Surfaces, hertz, perfect};
use creepage::chart::{Draw, Figure, Panel};
use creepage::check::{Basis, RunPaths};
use creepage::figures::{Choice, figures};
use std::collections::BTreeMap;
use std::path::Path;

fn maps(folder: &Path) -> Option<Figure> {
    let paths = RunPaths::of(folder).unwrap();
    let mut basis = Basis::read(&paths).unwrap();
    let all = figures(&paths, &mut basis, None, &Choice::default()).unwrap();
    all.into_iter().find(|named| named.stem == "contact-maps").map(|named| named.figure)
}

fn planted_maps() -> Figure {
    let folder = tempfile::tempdir().unwrap();
    planted::write(folder.path(), COULOMB, "exact", 3, |x, step| perfect(COULOMB, x, step));
    maps(folder.path()).unwrap()
}

fn panel<'a>(figure: &'a Figure, title: &str) -> &'a Panel {
    figure.panels.iter().find(|panel| panel.title == title).unwrap()
}

/// Arrows by their middle (nm), as vectors.
fn arrows(panel: &Panel) -> BTreeMap<[i64; 2], [f64; 2]> {
    let series = panel.series.iter().find(|s| matches!(s.draw, Draw::Arrows(_))).unwrap();
    let pairs = series.points.as_chunks::<2>().0.iter();
    pairs
        .map(|[tail, tip]| {
            let middle = [0, 1].map(|i| (0.5e6 * (tail[i] + tip[i])).round() as i64);
            (middle, [tip[0] - tail[0], tip[1] - tail[1]])
        })
        .collect()
}

#[test]
fn every_arrow_of_slip_is_opposed_by_that_of_shear_at_the_same_node() {
    let figure = planted_maps();
    let shear = arrows(panel(&figure, "Shear on the bar"));
    let slip = arrows(panel(&figure, "Slip velocity of the bar"));
    assert!(slip.len() > 10 && shear.len() > slip.len(), "{} {}", slip.len(), shear.len());
    for (node, s) in &slip {
        let t = shear[node];
        let cosine =
            (s[0] * t[0] + s[1] * t[1]) / libm::hypot(s[0], s[1]) / libm::hypot(t[0], t[1]);
        assert!((cosine + 1.0).abs() < 1e-9, "{node:?}: {cosine}");
    }
}

#[test]
fn only_nodes_in_contact_are_drawn_and_the_border_around_them_is_closed() {
    let figure = planted_maps();
    let at = |i: usize, j: usize| [H * i as f64 - 12e-3, H * j as f64 - 9e-3, 0.0];
    let bar = (0..NX + 4).flat_map(|i| (0..NY + 4).map(move |j| at(i, j)));
    let touching = bar.filter(|x| hertz(*x) > 0.01 * P0).count();
    for title in ["Pressure", "Shear on the bar", "Stick and slip", "Coefficient of friction"] {
        let panel = panel(&figure, title);
        assert_eq!(panel.fill.as_ref().unwrap().cells.len(), touching, "{title}");
        let border = &panel.series[0].points;
        let mut ends = BTreeMap::<[i64; 2], usize>::new();
        for point in border.iter().filter(|point| point[0].is_finite()) {
            *ends.entry(point.map(|x| (1e6 * x).round() as i64)).or_default() += 1;
        }
        assert!(border.len() > 60 && ends.values().all(|count| count % 2 == 0), "{title}");
    }
}

/// Both bodies one element wide.
fn slice() -> Surfaces {
    let mut s =
        Surfaces { points: vec![], faces: vec![], body: vec![], area: vec![], disk: 2 * NX };
    for body in [0u8, 1] {
        let first = s.points.len() as u32;
        for i in 0..NX {
            for j in 0..2 {
                s.points.push([H * i as f64 - 10e-3, H * j as f64, 0.0]);
                s.area.push(0.5 * H * H);
            }
        }
        for i in 0..NX as u32 - 1 {
            let [a, b, c, d] = [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1].map(|n| first + n);
            s.faces.push(if body == 1 { [a, b, c, d] } else { [a, d, c, b] });
            s.body.push(body);
        }
    }
    s
}

#[test]
fn a_case_in_plane_strain_has_no_map() {
    let folder = tempfile::tempdir().unwrap();
    planted::case(folder.path(), COULOMB, "exact");
    let (s, leave) = (slice(), Leave::default());
    let mut file = planted::create(&folder.path().join("contact.vtkhdf"), &s, leave);
    let node = |x: [f64; 3], _| -> Node {
        let pressure = hertz([x[0], 0.0, 0.0]);
        if pressure > 0.0 { Node { pressure, gap: 0.0, state: 1, ..OPEN } } else { OPEN }
    };
    for step in 0..3 {
        planted::append(&mut file, &s, step, 1e-7, leave, &node);
    }
    drop(file);
    assert!(maps(folder.path()).is_none());
}
