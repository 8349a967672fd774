//! Lines along y = 0 at up to three instants.

use super::caption::{caption, instants};
use super::half_space::{self, HalfSpaceShear};
use super::scene::{INSTANTS, Instant, Scene, time_label};
use crate::chart::{Axis, Draw, Figure, Panel, Series, colour};
use crate::check::surface::body_name;

/// A quantity of a record at a node, drawn against x.
type Quantity<'a> = &'a dyn Fn(&Instant, usize) -> f64;

fn x_axis(scene: &Scene<'_>) -> Axis {
    let reach = 1e3 * scene.line_reach;
    Axis::linear("x from the patch's centre (mm)").over(-reach, reach)
}

/// One quantity along y = 0 of a body within the range of x that is drawn: x relative to the patch's centre (mm),
/// value.
fn along(scene: &Scene<'_>, instant: &Instant, body: u8, quantity: Quantity<'_>) -> Vec<[f64; 2]> {
    let place = |row: usize| scene.position(&instant.frame, row)[0] - instant.centre;
    let rows = scene.centreline(body).into_iter();
    let inside = rows.filter(|&row| place(row).abs() <= scene.line_reach);
    inside.map(|row| [1e3 * place(row), quantity(instant, row)]).collect()
}

fn panel(title: &str, x: Axis, y: Axis, series: Vec<Series>) -> Panel {
    Panel { title: title.into(), series, ..Panel::new(x, y) }
}

/// Lines of a quantity, one for each instant.
fn at_instants(scene: &Scene<'_>, body: u8, quantity: Quantity<'_>) -> Vec<Series> {
    let instants = scene.instants.iter().zip(INSTANTS);
    instants
        .map(|(instant, colour)| Series {
            label: time_label(instant),
            points: along(scene, instant, body, quantity),
            draw: Draw::Line(colour),
        })
        .collect()
}

/// Figure 1: velocities of surface nodes along y = 0 on each body that has them, and the slip velocity of the body that
/// all figures draw, with the sign that it has in the records.
pub(super) fn velocities(scene: &Scene<'_>) -> Figure {
    let bodies = scene.history.surface.bodies();
    let velocity = |instant: &Instant, row: usize| {
        instant.frame.motion.as_ref().map_or(f64::NAN, |[_, velocity]| velocity[row][0])
    };
    let slip = |instant: &Instant, row: usize| instant.frame.slip_velocity[row][0];
    let [drawn, other] = [scene.body, u8::from(scene.body == 0)].map(body_name);
    let mut panels = Vec::new();
    if scene.history.has.motion {
        for &body in bodies.iter().rev() {
            let title = format!("Surface nodes of the {}", body_name(body));
            let series = at_instants(scene, body, &velocity);
            panels.push(panel(&title, x_axis(scene), Axis::linear("v_{x} (m/s)"), series));
        }
    }
    let title = format!("Slip velocity of the {drawn}");
    let series = at_instants(scene, scene.body, &slip);
    panels.push(panel(&title, x_axis(scene), Axis::linear("s_{x} (m/s)"), series));
    let surfaces = if bodies.len() == 2 { "both bodies".into() } else { format!("the {drawn}") };
    let velocities = if scene.history.has.motion {
        format!(
            "Velocities along x of the surface nodes on y = 0 of {surfaces}, and the slip velocity of the {drawn}"
        )
    } else {
        format!("Slip velocity along x of the surface nodes on y = 0 of the {drawn}")
    };
    let text = format!(
        "{velocities} relative to the {other}, at {}; rolling is to the right (the papers' Figure 1, where s is that of \
         the wheel relative to the rail).",
        instants(scene)
    );
    let columns = panels.len();
    Figure { size: [360 * columns as u32, 400], columns, panels, caption: caption(scene, &text) }
}

/// Figure 3: pressure and shear along y = 0 with the bounds of friction, beside a reference that was computed or else is known.
pub(super) fn tractions(scene: &Scene<'_>, computed: Option<HalfSpaceShear>) -> Figure {
    let mega = |values: Vec<[f64; 2]>| -> Vec<[f64; 2]> {
        values.into_iter().map(|[x, p]| [x, 1e-6 * p]).collect()
    };
    let pressure = |instant: &Instant, row: usize| instant.frame.pressure[row];
    let shear = |instant: &Instant, row: usize| instant.frame.shear[row].norm();
    let mut series = Vec::new();
    if let Some(last) = scene.instants.last() {
        let points = mega(along(scene, last, scene.body, &pressure));
        let bound = |factor: f64| points.iter().map(|[x, p]| [*x, factor * p]).collect();
        series.push(Series {
            label: format!("p_{{n}}, {}", time_label(last)),
            points: points.clone(),
            draw: Draw::Line(colour::BLACK),
        });
        let rest = scene.mu_static();
        series.push(Series {
            label: format!("\u{3bc}_{{S}} p_{{n}}, \u{3bc}_{{S}} = {rest}"),
            points: bound(rest),
            draw: Draw::Dashed(colour::BLACK),
        });
        if let Some(crate::check::Law::Exponential(law)) = scene.basis.law {
            series.push(Series {
                label: format!("\u{3bc}_{{D}} p_{{n}}, \u{3bc}_{{D}} = {}", law.mu_dynamic),
                points: bound(law.mu_dynamic),
                draw: Draw::Dashed(colour::GREY),
            });
        }
    }
    if let (Some(a), Some(p0)) =
        (scene.basis.scale("half_length"), scene.basis.scale("peak_pressure"))
    {
        let hertz = (0..=200)
            .map(|i| -a + 2.0 * a * f64::from(i) / 200.0)
            .map(|x| [1e3 * x, 1e-6 * p0 * (1.0 - (x / a).powi(2)).max(0.0).sqrt()]);
        series.push(Series {
            label: "p_{n}, half-space (Hertz)".into(),
            points: hertz.collect(),
            draw: Draw::Line(colour::ORANGE),
        });
    }
    let mut beside = String::new();
    if let Some(reference) = computed.or_else(|| half_space::shear(scene)) {
        beside = reference.text;
        series.push(Series {
            label: reference.label,
            points: reference.points.into_iter().map(|[x, p]| [1e3 * x, 1e-6 * p]).collect(),
            draw: Draw::Dashed(colour::ORANGE),
        });
    }
    for (instant, colour) in scene.instants.iter().zip(INSTANTS) {
        series.push(Series {
            label: format!("p_{{f}}, {}", time_label(instant)),
            points: mega(along(scene, instant, scene.body, &shear)),
            draw: Draw::Line(colour),
        });
    }
    let y = Axis::linear("traction (MPa)");
    let panels = vec![panel("", x_axis(scene), y, series)];
    let mut text = match scene.instants.len() {
        1 => {
            "Pressure, shear and the bound of friction (dashed) along y = 0 (the papers' Figure 3)."
                .to_owned()
        }
        n => format!(
            "Pressure along y = 0 at the last of {n} instants and shear at all of them (the papers' Figure 3); the bound \
             of friction (dashed) is that of the last."
        ),
    };
    text.push_str(&beside);
    Figure { size: [760, 500], columns: 1, panels, caption: caption(scene, &text) }
}

/// Figure 4: the bound mu(|s|) p_n beside the shear, as tractions and over the pressure.
pub(super) fn bound(scene: &Scene<'_>) -> Figure {
    let in_contact = |instant: &Instant, row: usize, value: f64| {
        if scene.in_contact(&instant.frame, row) { value } else { f64::NAN }
    };
    let mu = |instant: &Instant, row: usize| {
        let used = || instant.frame.mu.as_ref().map_or(f64::NAN, |mu| mu[row]);
        let speed = instant.frame.slip_velocity[row].norm();
        let mu = scene.basis.law.map_or_else(used, |law| law.mu(speed));
        in_contact(instant, row, mu)
    };
    let ratio = |instant: &Instant, row: usize| {
        let ratio = instant.frame.shear[row].norm() / instant.frame.pressure[row];
        in_contact(instant, row, ratio)
    };
    let pressure = |instant: &Instant, row: usize| 1e-6 * instant.frame.pressure[row];
    let mut panels = Vec::new();
    for relative in [false, true] {
        let mut series = Vec::new();
        if let (false, Some(last)) = (relative, scene.instants.last()) {
            series.push(Series {
                label: format!("{} p_{{n}}, {}", scene.mu_static(), time_label(last)),
                points: along(scene, last, scene.body, &|i, row| {
                    scene.mu_static() * pressure(i, row)
                }),
                draw: Draw::Line(colour::BLACK),
            });
        }
        for (instant, colour) in scene.instants.iter().zip(INSTANTS) {
            let scaled = |quantity: Quantity<'_>| {
                along(scene, instant, scene.body, &|i, row| match relative {
                    true => quantity(i, row),
                    false if scene.in_contact(&i.frame, row) => quantity(i, row) * pressure(i, row),
                    false => 0.0,
                })
            };
            let names = if relative {
                ["\u{3bc}(|s|)", "p_{f}/p_{n}"]
            } else {
                ["\u{3bc}(|s|) p_{n}", "p_{f}"]
            };
            series.push(Series {
                label: format!("{}, {}", names[0], time_label(instant)),
                points: scaled(&mu),
                draw: Draw::Dashed(colour),
            });
            series.push(Series {
                label: format!("{}, {}", names[1], time_label(instant)),
                points: scaled(&ratio),
                draw: Draw::Line(colour),
            });
        }
        let y = if relative {
            Axis::linear("p_{f}/p_{n} and \u{3bc}(|s|) (-)").over(0.0, 1.1 * scene.mu_static())
        } else {
            Axis::linear("traction (MPa)")
        };
        panels.push(panel("", x_axis(scene), y, series));
    }
    let text = "The bound of friction that the slip velocity of the same instant implies (dashed) \
                beside the shear (full), as tractions and relative to the pressure (the papers' \
                Figure 4). Where nodes slip the two lines must be one, and where the full line \
                lies below the dashed one there must be no slip.";
    Figure { size: [1080, 500], columns: 2, panels, caption: caption(scene, text) }
}
