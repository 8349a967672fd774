//! What the slider's results look like on a terminal.

use std::fmt::Write;

use creepage::{
    Method, Outcome, Parameters, SliderFound, TableRow, Tables, Threshold, Thresholds,
    penalty_stable_step,
};

/// A run, the thresholds of the explicit method, or the paper's tables.
pub fn text(found: &SliderFound) -> String {
    match found {
        SliderFound::Tables(found) => tables(found),
        SliderFound::Thresholds(found) => thresholds(found),
        SliderFound::Run(run) => {
            let figures = run.figures.iter().map(|path| format!("{}\n", path.display()));
            outcome(&run.parameters, run.method, &run.outcome) + &figures.collect::<String>()
        }
    }
}

/// One run.
fn outcome(p: &Parameters, method: Method, out: &Outcome) -> String {
    let mut page = format!("{}, dt {:e} s, {} steps\n", method.name(), p.dt, out.steps);
    let mut say = |name: &str, value: String| {
        let _ = writeln!(page, "  {name:<24}{value}");
    };
    say("x_min", format!("{:10.5} m", out.x_min));
    say(
        "x_max (t > 0.7 s)",
        if out.x_max.is_finite() {
            format!("{:10.5} m", out.x_max)
        } else {
            "         - (the run ends before)".into()
        },
    );
    say("v_max", format!("{:10.3} m/s", out.v_max));
    if out.adhesion_slip.is_finite() {
        let share = out.adhesion_slip / p.adhesion;
        say("rms s in adhesion", format!("{:10.3e} m/s, {share:.2} s_adhes", out.adhesion_slip));
    }
    if let Some(r) = out.ringing {
        let value = format!(
            "{:10.3e} m/s after the capture at {:.4} s (peak {:.3e}; later rms {:.3e})",
            r.rms, r.capture, r.peak, r.later_rms
        );
        say("rms s after capture", value);
    }
    match method {
        Method::Implicit => {
            let mean = out.picard as f64 / out.steps.max(1) as f64;
            let (most, fallbacks) = (out.most_picard, out.fallbacks);
            let value = format!("{mean:.2} per step, most {most}; {fallbacks} steps by bracketing");
            say("Picard iterations", value);
        }
        Method::Penalty => {
            say(
                "stable step",
                format!("{:10.3e} s for k_t = {:e} N/m", penalty_stable_step(p), p.stiffness),
            );
        }
        Method::Explicit | Method::Exact | Method::Memory => {}
    }
    page
}

/// The thresholds of the explicit method.
fn thresholds(found: &Thresholds) -> String {
    let mut page = String::from("explicit method       formula (s)  bisection (s)  difference\n");
    let mut line = |name: &str, t: Threshold| {
        let _ = match t.bisection {
            Some(found) => writeln!(
                page,
                "  {name:<18}{:13.4e}{found:15.4e}{:10.2} %",
                t.formula,
                100.0 * (found / t.formula - 1.0)
            ),
            None => writeln!(
                page,
                "  {name:<18}{:13.4e}              -  (no change between a third and three times \
                 the formula)",
                t.formula
            ),
        };
    };
    line("dt_1 (chatter)", found.chatter);
    match found.collapse {
        Some(t) => line("dt_2 (collapse)", t),
        None => page += "  dt_2 (collapse)   none: friction does not fall with slip speed\n",
    }
    page
}

/// The paper's tables.
fn tables(tables: &Tables) -> String {
    let mut page = String::new();
    let named = [
        ("Table 2: implicit, refinement of the time step", &tables.table2),
        ("Table 3: implicit, mass and damping", &tables.table3),
        ("Table 4: explicit, refinement of the time step", &tables.table4),
    ];
    for (title, rows) in named {
        let _ = writeln!(page, "{title}");
        let _ = writeln!(
            page,
            "      m       c      dt      x_min    paper     diff    x_max    paper     diff    \
             v_max    paper    diff"
        );
        rows.iter().for_each(|row| table_line(&mut page, row));
        page.push('\n');
    }
    page += "chaotic: above dt_2 the block collapses out of chatter; its digits depend on the last \
             bit of every operation, so that only about 0.01 in x can be compared\n";
    page
}

fn table_line(page: &mut String, row: &TableRow) {
    let (a, b) = (row.computed, row.paper);
    let _ = writeln!(
        page,
        "{:7} {:7} {:7.0e}  {:9.5} {:8.5} {:8.5}  {:8.5} {:8.5} {:8.5}  {:7.3} {:8.3} {:7.3}{}",
        row.mass,
        row.damping,
        row.dt,
        a.x_min,
        b.x_min,
        a.x_min - b.x_min,
        a.x_max,
        b.x_max,
        a.x_max - b.x_max,
        a.v_max,
        b.v_max,
        a.v_max - b.v_max,
        if row.chaotic { "  chaotic" } else { "" }
    );
}
