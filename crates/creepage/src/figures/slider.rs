//! The paper's Figures 6 to 8 and the map of the time step.

use slider::{
    BlowUp, MapPoint, Method, ParameterError, Parameters, State, chatter_step, collapse_step, map,
    run,
};
use slider::{SMALLEST_STEP, map_end};
use std::ops::ControlFlow;

use crate::chart::{Axis, Draw, Figure, Mark, Panel, Series, colour, minus, thin};

/// Time, and the block at that time.
type Sample = (f64, State);

/// Lines are thinned for so many columns of pixels.
const COLUMNS: usize = 1500;

/// Most steps of a run that is drawn: every step is kept, in 48 bytes.
const MOST_DRAWN: f64 = 2e7;

/// Most steps of a run of the map at its smallest time step; the whole map then takes minutes.
const MOST_MAPPED: f64 = 5e8;

/// Checks that the figures need no more than about 1 GB of memory for a run, and minutes for the map.
///
/// # Errors
/// A time step or an end that gives too many steps.
pub fn drawable(p: &Parameters) -> Result<(), ParameterError> {
    if p.end / p.dt > MOST_DRAWN {
        let allowed = "at least t_end/2e7 for figures: they keep every step in memory";
        return Err(ParameterError { key: "dt", value: p.dt, unit: "s", allowed: allowed.into() });
    }
    if map_end(p) / SMALLEST_STEP > MOST_MAPPED {
        let allowed = "at most 50 s for the map of the time step, unless the block breaks loose \
                       before";
        return Err(ParameterError {
            key: "t_end",
            value: p.end,
            unit: "s",
            allowed: allowed.into(),
        });
    }
    Ok(())
}

fn history(p: &Parameters, method: Method) -> Result<Vec<Sample>, BlowUp> {
    let mut samples = Vec::new();
    run(p, method, |time, state| {
        samples.push((time, *state));
        ControlFlow::Continue(())
    })?;
    Ok(samples)
}

fn line(label: &str, samples: &[Sample], colour: [u8; 3], value: impl Fn(&State) -> f64) -> Series {
    let points: Vec<_> = samples.iter().map(|(t, state)| [*t, value(state)]).collect();
    Series { label: label.into(), points: thin(&points, COLUMNS), draw: Draw::Line(colour) }
}

fn panel(title: &str, y: Axis, series: Vec<Series>, [from, to]: [f64; 2]) -> Panel {
    let x = Axis::linear("t (s)").over(from, to);
    Panel { title: title.into(), series, ..Panel::new(x, y) }
}

/// The panels of x, of v, of s, and of the forces against time.
fn panels(p: &Parameters, title: &str, samples: &[Sample], span: [f64; 2]) -> [Panel; 4] {
    let spring = |s: &State| -p.damping * s.v - p.spring * s.x;
    let forces = vec![
        line("F_{fric}", samples, colour::VERMILION, |s| s.friction),
        line("F_{spring}", samples, colour::BLUE, spring),
    ];
    let one =
        |label: &str, colour, value: fn(&State) -> f64| vec![line(label, samples, colour, value)];
    [
        panel(title, Axis::linear("x (m)"), one("x", colour::BLUE, |s| s.x), span),
        panel("", Axis::linear("v (m/s)"), one("v", colour::BLUE, |s| s.v), span),
        panel("", Axis::linear("s (m/s)"), one("s", colour::GREEN, |s| s.slip), span),
        panel("", Axis::linear("force (N)"), forces, span),
    ]
}

fn title(method: Method, p: &Parameters) -> String {
    format!("{}, dt = {} s", method.name(), minus(&format!("{:e}", p.dt)))
}

fn step_label(symbol: &str, step: f64) -> String {
    format!("{symbol} = {} s", minus(&format!("{step:.3e}")))
}

/// Figure 6: x, v, s and the forces against time for two methods side by side; in the paper the
/// implicit and the explicit one.
///
/// # Errors
/// A run that blows up.
pub fn figure_6(p: &Parameters, methods: [Method; 2]) -> Result<Figure, BlowUp> {
    let mut columns = Vec::new();
    for method in methods {
        let samples = history(p, method)?;
        columns.push(panels(p, &title(method, p), &samples, [0.0, p.end]));
    }
    let rows = (0..4).flat_map(|row| columns.iter().map(move |column| column[row].clone()));
    Ok(Figure { size: [960, 960], columns: 2, panels: rows.collect(), caption: String::new() })
}

/// Figure 7: for two methods, the coefficient of friction used in each step against the slip speed at its end, over
/// the curve of the law.
///
/// # Errors
/// A run that blows up.
pub fn figure_7(p: &Parameters, methods: [Method; 2]) -> Result<Figure, BlowUp> {
    const LAW: usize = 400;
    const FASTEST: f64 = 2.5;
    let law = (0..=LAW).map(|i| FASTEST * i as f64 / LAW as f64).map(|s| [s, p.mu(s)]);
    let law = Series {
        label: "law, Eq (17)".into(),
        points: law.collect(),
        draw: Draw::Line(colour::BLACK),
    };
    let mut panels = Vec::new();
    for (method, dots) in methods.into_iter().zip([colour::BLUE, colour::VERMILION]) {
        let samples = history(p, method)?;
        let points: Vec<_> = samples.iter().skip(1).map(|(_, s)| [s.slip.abs(), s.mu]).collect();
        let points = dots_apart(&points, [FASTEST / 800.0, 5e-4]);
        let label = format!("{} method", method.name());
        panels.push(Panel {
            title: title(method, p),
            series: vec![Series { label, points, draw: Draw::Dots(dots, 1.2) }, law.clone()],
            ..Panel::new(
                Axis::linear("|s| (m/s)").over(0.0, FASTEST),
                Axis::linear("coefficient of friction \u{3bc} (-)"),
            )
        });
    }
    Ok(Figure { size: [960, 400], columns: 2, panels, caption: String::new() })
}

/// One point of each cell of a grid: dots that would cover each other are drawn once.
fn dots_apart(points: &[[f64; 2]], cell: [f64; 2]) -> Vec<[f64; 2]> {
    let mut seen = std::collections::HashSet::new();
    let place = |p: &[f64; 2]| [0, 1].map(|i: usize| (p[i] / cell[i]).floor() as i64);
    points.iter().filter(|p| seen.insert(place(p))).copied().collect()
}

/// Figure 8: x, v, s, mu and the forces of one method against time, from `span[0]` to `span[1]` (s); in the paper the
/// explicit one.
///
/// # Errors
/// A run that blows up.
pub fn figure_8(p: &Parameters, method: Method, span: [f64; 2]) -> Result<Figure, BlowUp> {
    let mut samples = history(p, method)?;
    samples.retain(|(t, _)| (span[0]..=span[1]).contains(t));
    let [x, v, s, forces] = panels(p, "", &samples, span);
    let mu = vec![line("\u{3bc}", &samples, colour::PURPLE, |s| s.mu)];
    let mu = panel("", Axis::linear("\u{3bc} (-)"), mu, span);
    let mut panels = vec![x, v, s, mu, forces];
    panels[0].title = title(method, p);
    Ok(Figure { size: [640, 1000], columns: 1, panels, caption: String::new() })
}

/// The map of the time step: x_min and the slip in adhesion against dt from 1e-7 to 1e-3 s, for the explicit, implicit,
/// penalty and exact methods, with the explicit method's thresholds by formula.
pub fn time_step_map(p: &Parameters) -> Figure {
    let methods = [
        (Method::Explicit, -7, colour::VERMILION),
        (Method::Implicit, -6, colour::BLUE),
        (Method::Penalty, -7, colour::ORANGE),
        (Method::Exact, -7, colour::GREEN),
    ];
    let maps: Vec<_> = methods
        .map(|(method, from, colour)| (method, map(p, method, from, -3), colour))
        .into_iter()
        .collect();
    let series = |value: fn(&MapPoint, &Parameters) -> f64| {
        maps.iter()
            .map(|(method, points, colour)| {
                let label = match method {
                    Method::Penalty => format!("penalty, k_{{t}} = {:e} N/m", p.stiffness),
                    method => method.name().into(),
                };
                let points = points.iter().map(|m| [m.dt, value(m, p)]).collect();
                Series { label, points, draw: Draw::Line(*colour) }
            })
            .collect::<Vec<_>>()
    };
    let mut marks = vec![Mark {
        x: chatter_step(p),
        label: step_label("dt_{1}", chatter_step(p)),
        colour: colour::GREY,
    }];
    if let Some(x) = collapse_step(p) {
        marks.push(Mark { x, label: step_label("dt_{2}", x), colour: colour::BLACK });
    }
    let dt = || Axis::log("dt (s)").over(1e-7, 1e-3);
    let mut slip = series(|m, p| m.adhesion_slip / p.adhesion);
    // its slip in adhesion is zero, which a logarithmic axis cannot show
    slip.retain(|s| s.label != Method::Exact.name());
    let panels = vec![
        Panel {
            title: "Where the block breaks loose".into(),
            series: series(|m, _| m.x_min),
            marks: marks.clone(),
            ..Panel::new(dt(), Axis::linear("x_{min} (m)"))
        },
        Panel {
            title: "Slip in adhesion (exact: zero)".into(),
            series: slip,
            marks,
            ..Panel::new(dt(), Axis::log("rms s / s_{adhes} (-)"))
        },
    ];
    Figure { size: [760, 760], columns: 1, panels, caption: String::new() }
}
