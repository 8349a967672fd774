//! `creepage slider`.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use contact::FrictionLaw;
use miette::miette;
use serde_json::{Value, json};
use slider::tables::{Row, Tables, tables};
use slider::{Method, Parameters, State, run};

use crate::args::Args;
use crate::commands::{BAD_INPUT, Failure};
use crate::report;

/// Options of `slider`.
#[derive(Debug, clap::Args)]
pub struct SliderArgs {
    /// Time stepping: backward Euler (Eqs 19-27) or the paper's explicit method (Eqs 28-32)
    #[arg(long, value_enum, default_value = "implicit")]
    pub method: Stepping,
    /// Time step (s)
    #[arg(long, value_name = "S", default_value_t = 1e-4, allow_negative_numbers = true)]
    pub dt: f64,
    /// Mass (kg)
    #[arg(long, value_name = "KG", default_value_t = 0.01, allow_negative_numbers = true)]
    pub mass: f64,
    /// Damping (N s/m)
    #[arg(long, value_name = "C", default_value_t = 0.04, allow_negative_numbers = true)]
    pub damping: f64,
    /// Simulated time (s)
    #[arg(long, value_name = "S", default_value_t = 5.0, allow_negative_numbers = true)]
    pub t_end: f64,
    /// Write time, position, velocity, slip velocity, friction coefficient and forces of every step
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Compute Tables 2, 3 and 4 of the paper and set them beside the printed values
    #[arg(long, conflicts_with_all = ["csv", "dt", "mass", "damping", "t_end", "method"])]
    pub tables: bool,
}

/// The methods by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Stepping {
    /// Backward Euler
    Implicit,
    /// Explicit
    Explicit,
}

/// Runs the command.
pub fn command(args: &Args, options: &SliderArgs) -> Result<u8, Failure> {
    if options.tables {
        let tables = tables();
        show(args, &json!(tables), || tables_page(&tables));
        return Ok(0);
    }
    let parameters = Parameters {
        dt: options.dt,
        mass: options.mass,
        damping: options.damping,
        end: options.t_end,
        ..Parameters::default()
    };
    let parameters = parameters.checked().map_err(|error| {
        bad_input(miette!(help = "`creepage slider --help` lists the options", "{error}"))
    })?;
    let (method, name) = match options.method {
        Stepping::Implicit => (Method::Implicit, "implicit"),
        Stepping::Explicit => (Method::Explicit, "explicit"),
    };
    let mut csv = options.csv.as_deref().map(|path| Csv::new(path, parameters)).transpose()?;
    let out = run(&parameters, method, |time, state| {
        if let Some(csv) = &mut csv {
            csv.row(time, state);
        }
    });
    if let Some(csv) = csv {
        csv.finish()?;
    }
    let x_max = out.x_max.is_finite().then_some(out.x_max);
    let document = json!({
        "method": name, "dt": parameters.dt, "mass": parameters.mass,
        "damping": parameters.damping, "x_min": out.x_min, "x_max": x_max, "v_max": out.v_max,
        "steps": out.steps, "picard_iterations": out.picard, "fallback_steps": out.fallbacks,
    });
    show(args, &document, || {
        let mut page = format!("{name}, dt {:e} s, {} steps\n", parameters.dt, out.steps);
        let _ = writeln!(page, "  x_min              {:10.5} m", out.x_min);
        let _ = match x_max {
            Some(x) => writeln!(page, "  x_max (t > 0.7 s)  {x:10.5} m"),
            None => writeln!(page, "  x_max (t > 0.7 s)           - (the run ends before)"),
        };
        let _ = writeln!(page, "  v_max              {:10.3} m/s", out.v_max);
        if method == Method::Implicit {
            let mean = out.picard as f64 / out.steps as f64;
            let _ = writeln!(
                page,
                "  {mean:.2} Picard iterations per step; {} steps by bisection",
                out.fallbacks
            );
        }
        page
    });
    Ok(0)
}

fn show(args: &Args, document: &Value, page: impl FnOnce() -> String) {
    if args.json {
        report::print_json(document);
    } else if !args.quiet {
        let _ = write!(std::io::stdout(), "{}", page());
    }
}

fn bad_input(report: miette::Report) -> Failure {
    Failure { report, code: BAD_INPUT }
}

fn tables_page(tables: &Tables) -> String {
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
        rows.iter().for_each(|row| line(&mut page, row));
        page.push('\n');
    }
    page += "chaotic: the run chatters through adhesion; its digits depend on the last bit of every \
             operation, so that only about 0.01 in x can be compared\n";
    page
}

fn line(page: &mut String, row: &Row) {
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

/// The history of a run; the first error is kept for the end.
struct Csv {
    path: PathBuf,
    out: BufWriter<File>,
    parameters: Parameters,
    error: Option<std::io::Error>,
}

impl Csv {
    fn new(path: &Path, parameters: Parameters) -> Result<Self, Failure> {
        let header = "t_s,x_m,v_m_s,s_m_s,mu,friction_N,spring_N\n";
        let open = || -> std::io::Result<BufWriter<File>> {
            let mut out = BufWriter::new(File::create(path)?);
            out.write_all(header.as_bytes())?;
            Ok(out)
        };
        let out = open().map_err(|cause| unwritable(path, &cause))?;
        Ok(Self { path: path.to_path_buf(), out, parameters, error: None })
    }

    fn row(&mut self, time: f64, State { x, v }: State) {
        let p = &self.parameters;
        let slip = v - p.belt;
        let (mu, friction) = (p.law.mu(slip.abs()), p.friction(slip));
        let spring = -p.damping * v - p.spring * x;
        if self.error.is_none() {
            let written = writeln!(self.out, "{time},{x},{v},{slip},{mu},{friction},{spring}");
            self.error = written.err();
        }
    }

    fn finish(mut self) -> Result<(), Failure> {
        match self.error.take().or(self.out.flush().err()) {
            None => Ok(()),
            Some(cause) => Err(unwritable(&self.path, &cause)),
        }
    }
}

fn unwritable(path: &Path, cause: &std::io::Error) -> Failure {
    bad_input(miette!(
        help = "give a path in a folder that you may write to",
        "--csv {}: cannot write the file: {cause}",
        path.display()
    ))
}
