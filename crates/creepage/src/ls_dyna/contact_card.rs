//! The card of the contact.

use crate::ls_dyna::cards::{Card, Line};
use crate::ls_dyna::deck::{Contact, Side};
use crate::ls_dyna::error::{DeckError, DeckLine, unsupported};
use crate::ls_dyna::fields::{
    Layout, absent, number, output, real, real_or, rests, search, whole, zero,
};

const SIDES: Layout<4> = Layout::new(&[
    number("SSID"),
    number("MSID"),
    whole("SSTYP"),
    whole("MSTYP"),
    zero("SBOXID"),
    zero("MBOXID"),
    output("SPR"),
    output("MPR"),
]);

const FRICTION: Layout<5> = Layout::new(&[
    real("FS"),
    real("FD"),
    real("DC"),
    zero("VC"),
    real("VDC"),
    zero("PENCHK"),
    zero("BT"),
    real_or("DT", 1e20),
]);

const SCALES: Layout<2> = Layout::new(&[
    real_or("SFS", 1.0),
    real_or("SFM", 1.0),
    zero("SST"),
    zero("MST"),
    rests("SFST", &[1.0]),
    rests("SFMT", &[1.0]),
    rests("FSF", &[1.0]),
    rests("VSF", &[1.0]),
]);

/// The optional cards A to G.
const OPTIONAL: [Layout<0>; 7] = [
    Layout::new(&[
        zero("SOFT"),
        search("SOFSCL"),
        zero("LCIDAB"),
        search("MAXPAR"),
        search("SBOPT"),
        search("DEPTH"),
        search("BSORT"),
        rests("FRCFRQ", &[1.0]),
    ]),
    Layout::new(&[
        zero("PENMAX"),
        zero("THKOPT"),
        absent("SHLTHK"),
        zero("SNLOG"),
        zero("ISYM"),
        zero("I2D3D"),
        zero("SLDTHK"),
        zero("SLDSTF"),
    ]),
    Layout::new(&[
        rests("IGAP", &[1.0]),
        zero("IGNORE"),
        zero("DPRFAC"),
        zero("DTSTIF"),
        zero("EDGEK"),
        zero("unused"),
        zero("FLANGL"),
        output("CID_RCF"),
    ]),
    Layout::new(&[
        zero("Q2TRI"),
        zero("DTPCHK"),
        zero("SFNBR"),
        zero("FNLSCL"),
        zero("DNLSCL"),
        zero("TCSO"),
        zero("TIEDID"),
        absent("SHLEDG"),
    ]),
    Layout::new(&[
        zero("SHAREC"),
        zero("CPARM8"),
        zero("IPBACK"),
        zero("SRNDE"),
        rests("FRICSF", &[1.0]),
        zero("ICOR"),
        zero("FTORQ"),
        zero("REGION"),
    ]),
    Layout::new(&[
        zero("PSTIFF"),
        zero("IGNROFF"),
        zero("unused"),
        rests("FSTOL", &[2.0]),
        zero("2DBINR"),
        zero("SSFTYP"),
        zero("SWTPR"),
        zero("TETFAC"),
    ]),
    Layout::new(&[zero("unused"), absent("SHLOFF")]),
];

/// Reads the card of the contact.
///
/// # Errors
/// Fields without a place in a case, with their line.
pub(super) fn read(card: &Card) -> Result<Contact, DeckError> {
    let sides = card.line(0)?;
    let [first, second, first_kind, second_kind] = sides.take(&SIDES)?;
    let friction = card.line(1)?;
    let [fs, fd, dc, vdc, ends] = friction.take(&FRICTION)?;
    if fs < 0.0 || fs == 2.0 {
        let what = format!("*{} with FS = {fs}, which stands for friction by a table", card.name);
        let remedy = "give FS, FD and DC on the card of the contact";
        return Err(unsupported(&friction.place(), what, remedy));
    }
    let scales = card.line_or_blank(2);
    let [sf, sfm] = scales.take(&SCALES)?;
    if sf != sfm {
        let what = format!("*{} with SFS = {sf} and SFM = {sfm}", card.name);
        let remedy = "give both one value: both passes are alike";
        return Err(unsupported(&scales.place(), what, remedy));
    }
    for (i, layout) in OPTIONAL.iter().enumerate() {
        card.line_or_blank(3 + i).take(layout)?;
    }
    card.ends_after(3 + OPTIONAL.len())?;
    Ok(Contact {
        place: card.place.clone(),
        sides: [side(sides, 0, first, first_kind)?, side(sides, 1, second, second_kind)?],
        fs,
        fd,
        dc,
        vdc,
        ends: (friction.place(), ends),
        sf,
    })
}

/// The first line of a contact whose results are read, of which the sides alone count.
const SIDES_ALONE: Layout<4> = Layout::new(&[
    number("SSID"),
    number("MSID"),
    whole("SSTYP"),
    whole("MSTYP"),
    output("SBOXID"),
    output("MBOXID"),
    output("SPR"),
    output("MPR"),
]);

/// The second line, of which the law of friction alone counts.
const LAW_ALONE: Layout<3> = Layout::new(&[
    real("FS"),
    real("FD"),
    real("DC"),
    output("VC"),
    output("VDC"),
    output("PENCHK"),
    output("BT"),
    output("DT"),
]);

/// What results of a contact refer to.
pub(super) struct Sliding {
    pub(super) place: DeckLine,
    pub(super) sides: [Side; 2],
    /// FS, FD and DC; none where parts or tables give the friction.
    pub(super) friction: Option<[f64; 3]>,
}

/// Reads what results of a contact refer to; how it is enforced does not matter for them.
pub(super) fn sliding(card: &Card) -> Result<Sliding, DeckError> {
    let sides = card.line(0)?;
    let [first, second, first_kind, second_kind] = sides.take(&SIDES_ALONE)?;
    let law = card.line(1)?.take(&LAW_ALONE)?;
    Ok(Sliding {
        place: card.place.clone(),
        sides: [side(sides, 0, first, first_kind)?, side(sides, 1, second, second_kind)?],
        friction: (law[0] >= 0.0 && law[0] != 2.0).then_some(law),
    })
}

/// A side of the contact: a set of segments, or parts.
fn side(line: Line, which: usize, id: f64, kind: f64) -> Result<Side, DeckError> {
    let id = id as u64;
    match kind as i64 {
        0 => Ok(Side::Segments(id)),
        2 => Ok(Side::PartSet(id)),
        3 => Ok(Side::Part(id)),
        kind => {
            let name = ["SSTYP (SURFATYP)", "MSTYP (SURFBTYP)"][which];
            let what = format!("*CONTACT with {name} = {kind}");
            let remedy = "give each side as a segment set (0), a part set (2) or a part (3)";
            Err(unsupported(&line.place(), what, remedy))
        }
    }
}
