//! The 1-D slider: the paper's Tables 2 and 3 (implicit), and the regular rows of Table 4.

use crate::problem::{Outcome, Size};
use crate::row::Row;
use slider::tables::{self, tables};

const SOURCE: &str = "Vollebregt (2017), Tables 2 to 4";

pub(crate) fn run(_: Size) -> Outcome {
    let tables = tables()?;
    let printed = |row: &tables::TableRow, limits: [f64; 2], from: &str, table: u8| {
        let (a, b) = (row.computed, row.paper);
        let what = format!("m {} c {} dt {:e}", row.mass, row.damping, row.dt);
        let named = |name: &str| format!("Table {table}, {what}: {name}");
        [
            Row::new(named("x_min (m)"), [b.x_min, a.x_min], 1.0, (limits[0], from), SOURCE),
            Row::new(named("x_max (m)"), [b.x_max, a.x_max], 1.0, (limits[0], from), SOURCE),
            Row::new(named("v_max (m/s)"), [b.v_max, a.v_max], 1.0, (limits[1], from), SOURCE),
        ]
    };
    let mut rows = Vec::new();
    for (table, list) in [(2, &tables.table2), (3, &tables.table3)] {
        for row in list {
            rows.extend(printed(row, [0.5e-5, 0.5e-3], "half of the last printed digit", table));
        }
    }
    // the last digits of Table 4 depend on the order of operations, which the paper does not print
    for row in tables.table4.iter().filter(|row| !row.chaotic) {
        rows.extend(printed(row, [5e-5, 3e-3], "asked of this problem", 4));
    }
    Ok(rows)
}
