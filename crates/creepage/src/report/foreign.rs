//! Records of another program: what cannot be judged by them, and why.

use super::escape;
use crate::check::basis::Basis;
use crate::check::digits::digits;
use crate::check::patch_series::PatchMeasure;
use crate::check::result::CheckResult;
use output::layout::file;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Whether the records are of another program: every run writes its history, they have none.
pub(super) fn is_foreign(basis: &Basis, folder: &Path) -> bool {
    basis.summary.is_none() && !output::is_ours(&folder.join(file::HISTORY))
}

/// Appends the table of what was not judged.
pub(super) fn not_judged(out: &mut String, basis: &Basis, checked: &CheckResult) {
    let mut rows = by_reason(checked);
    let [first, last] = checked.recorded;
    if checked.steps > 1 {
        let interval = digits(1e6 * (last - first) / (checked.steps - 1) as f64, 3);
        rows.push((
            "the time between records".into(),
            format!("records lie {interval} \u{3bc}s apart: what is faster does not show"),
        ));
    }
    if checked.pairing.records_with_the_other == 0 {
        rows.push((
            "traction with the slip of the step after it".into(),
            "no two records are known to lie one step apart (--scale dt=S)".into(),
        ));
    }
    if basis.window.is_none() && checked.window == checked.recorded {
        rows.push((
            "when rolling is steady".into(),
            "no evaluation window is stated: --window T0:T1 or --transits N chooses other records"
                .into(),
        ));
    }
    out.push_str(
        "<h3>What these records cannot show</h3>\n<div class=\"wide\"><table id=\"not-judged\">\n",
    );
    out.push_str("<tr><th>not judged</th><th>why</th></tr>\n");
    for (what, why) in rows {
        let _ = writeln!(out, "<tr><td>{}</td><td>{}</td></tr>", escape(&what), escape(&why));
    }
    out.push_str("</table></div>\n");
}

/// The measures without a value, those of one reason together.
fn by_reason(checked: &CheckResult) -> Vec<(String, String)> {
    let conditions = checked.metrics.iter().filter(|(_, metric)| metric.value.is_none());
    let conditions = conditions.map(|(measure, metric)| (measure.name(), metric.note.as_deref()));
    let means = PatchMeasure::ALL.iter().filter_map(|measure| match checked.patch.get(measure) {
        Some(found) if found.mean.is_some() => None,
        Some(found) => Some((measure.name(), found.note.as_deref())),
        None => Some((measure.name(), Some("records of contact do not hold it"))),
    });
    let mut reasons = BTreeMap::<&str, Vec<&str>>::new();
    for (name, why) in conditions.chain(means) {
        reasons.entry(why.unwrap_or("no data")).or_default().push(name);
    }
    reasons.into_iter().map(|(why, names)| (names.join(", "), why.into())).collect()
}
