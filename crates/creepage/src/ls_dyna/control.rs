//! Cards of the method and of output.

use crate::ls_dyna::bodies::stiffness_form;
use crate::ls_dyna::cards::Card;
use crate::ls_dyna::deck::{Deck, Hourglass};
use crate::ls_dyna::error::{DeckError, unsupported};
use crate::ls_dyna::fields::{Layout, absent, output, real, real_or, rests, search, whole, zero};

const HOURGLASS: Layout<2> = Layout::new(&[whole("IHQ"), real_or("QH", 0.1)]);

const BULK_VISCOSITY: Layout<2> = Layout::new(&[
    real_or("Q1", 1.5),
    real_or("Q2", 0.06),
    rests("TYPE", &[1.0]),
    absent("BTYPE"),
    absent("TSTYPE"),
]);

const CONTACT: Layout<1> = Layout::new(&[
    real_or("SLSFAC", 0.1),
    absent("RWPNAL"),
    search("ISLCHK"),
    absent("SHLTHK"),
    rests("PENOPT", &[1.0]),
    absent("THKCHG"),
    search("ORIEN"),
    absent("ENMASS"),
]);

/// The further cards of `*CONTROL_CONTACT`.
const CONTACT_FURTHER: [Layout<0>; 6] = [
    Layout::new(&[
        zero("USRSTR"),
        zero("USRFRC"),
        search("NSBCS"),
        zero("INTERM"),
        search("XPENE"),
        absent("SSTHK"),
        zero("ECDT"),
        absent("TIEDPRJ"),
    ]),
    Layout::new(&[
        zero("SFRIC"),
        zero("DFRIC"),
        zero("EDC"),
        zero("VFC"),
        zero("TH"),
        rests("TH_SF", &[1.0]),
        rests("PEN_SF", &[1.0]),
        rests("PTSCL", &[1.0]),
    ]),
    Layout::new(&[
        zero("IGNORE"),
        output("FRCENG"),
        absent("SKIPRWG"),
        output("OUTSEG"),
        absent("SPOTSTP"),
        absent("SPOTDEL"),
        absent("SPOTHIN"),
        zero("DIR_TIE"),
    ]),
    Layout::new(&[
        zero("ISYM"),
        absent("NSEROD"),
        absent("RWGAPS"),
        absent("RWGDTH"),
        absent("RWKSF"),
        zero("ICOV"),
        absent("SWRADF"),
        zero("ITHOFF"),
    ]),
    Layout::new(&[
        absent("SHLEDG"),
        zero("PSTIFF"),
        zero("ITHCNT"),
        zero("TDCNOF"),
        zero("FTALL"),
        zero("unused"),
        absent("SHLTRW"),
        zero("IGACTC"),
    ]),
    Layout::new(&[
        zero("IREVSPT"),
        zero("unused"),
        zero("COHTIEM"),
        zero("TIEOPT"),
        zero("STROBJ"),
        zero("BEFBLK"),
    ]),
];

const TIMESTEP: Layout<1> = Layout::new(&[
    zero("DTINIT"),
    real_or("TSSFAC", 0.9),
    absent("ISDO"),
    absent("TSLIMT"),
    zero("DT2MS"),
    zero("LCTM"),
    zero("ERODE"),
    zero("MS1ST"),
]);

/// The further cards of `*CONTROL_TIMESTEP`.
const TIMESTEP_FURTHER: [Layout<0>; 2] = [
    Layout::new(&[
        zero("DT2MSF"),
        zero("DT2MSLC"),
        zero("IMSCL"),
        zero("unused"),
        zero("unused"),
        zero("RMSCL"),
        zero("EMSCL"),
        absent("IHDO"),
    ]),
    Layout::new(&[zero("RMAVG"), absent("IGADO"), zero("DTUSR"), zero("DTDYNV")]),
];

const TERMINATION: Layout<1> = Layout::new(&[
    real("ENDTIM"),
    zero("ENDCYC"),
    zero("DTMIN"),
    zero("ENDENG"),
    rests("ENDMAS", &[1e8]),
    zero("NOSOL"),
]);

/// Intervals between two records. LCDT or NPLTC would take the place of DT.
const INTERVAL: Layout<1> = Layout::new(&[
    real("DT"),
    zero("LCDT"),
    output("BEAM"),
    zero("NPLTC"),
    output("PSETID"),
    output("CID"),
]);

const RECORDS: Layout<0> = Layout::new(&[
    output("IOOPT"),
    output("RATE"),
    output("CUTOFF"),
    output("WINDOW"),
    output("TYPE"),
    output("PSET"),
]);

impl Deck {
    /// Takes a card of the method or of output; whether it is one.
    pub(super) fn control_card(&mut self, card: &Card) -> Result<bool, DeckError> {
        match card.name.as_str() {
            "CONTROL_HOURGLASS" => {
                let line = card.line(0)?;
                let [form, coefficient] = line.take(&HOURGLASS)?;
                stiffness_form(form, card, &line.place())?;
                card.ends_after(1)?;
                self.hourglass.insert(0, Hourglass { coefficient, bulk: None });
            }
            "CONTROL_BULK_VISCOSITY" => {
                self.bulk = card.line(0)?.take(&BULK_VISCOSITY)?;
                card.ends_after(1)?;
            }
            "CONTROL_CONTACT" => {
                let [slsfac] = card.line(0)?.take(&CONTACT)?;
                further(card, &CONTACT_FURTHER)?;
                self.slsfac = slsfac;
            }
            "CONTROL_TIMESTEP" => {
                let [factor] = card.line(0)?.take(&TIMESTEP)?;
                further(card, &TIMESTEP_FURTHER)?;
                self.tssfac = factor;
            }
            "CONTROL_TERMINATION" => {
                let [end] = card.line(0)?.take(&TERMINATION)?;
                card.ends_after(1)?;
                self.endtim = Some(end);
            }
            "CONTROL_UNITS" => self.named_units(card)?,
            "DATABASE_BINARY_D3PLOT" => self.intervals[0] = interval(card)?,
            "DATABASE_BINARY_INTFOR" => self.intervals[1] = interval(card)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Takes the names of the deck's units: LENGTH, TIME, MASS and TEMP, of which the last has no effect.
    fn named_units(&mut self, card: &Card) -> Result<(), DeckError> {
        let line = card.line(0)?;
        card.ends_after(1)?;
        let words = line.words()?;
        let word = |i: usize| words.get(i).map_or(String::new(), |word| word.to_lowercase());
        let length = match word(0).as_str() {
            "" | "m" => "m",
            "cm" => "cm",
            "mm" => "mm",
            "in" => "in",
            _ => "",
        };
        let time = match word(1).as_str() {
            "" | "s" | "sec" => "s",
            "ms" | "msec" => "ms",
            "us" | "micro_s" => "us",
            _ => "",
        };
        let mass = match word(2).as_str() {
            "" | "kg" => "kg",
            "g" => "g",
            "ton" | "mton" | "mtrc_ton" => "ton",
            _ => "",
        };
        if [length, mass, time].contains(&"") {
            let what = format!("*CONTROL_UNITS with {}", line.text.trim());
            let remedy = "leave the card out, and write the numbers in units that --unit knows";
            return Err(unsupported(&line.place(), what, remedy));
        }
        self.units = Some((line.place(), [length, mass, time]));
        Ok(())
    }
}

/// Reads the cards after the first of a keyword.
fn further(card: &Card, layouts: &[Layout<0>]) -> Result<(), DeckError> {
    for (i, layout) in layouts.iter().enumerate() {
        card.line_or_blank(1 + i).take(layout)?;
    }
    card.ends_after(1 + layouts.len())
}

/// The interval of the records that a card asks for.
fn interval(card: &Card) -> Result<f64, DeckError> {
    let [interval] = card.line(0)?.take(&INTERVAL)?;
    card.line_or_blank(1).take(&RECORDS)?;
    card.ends_after(2)?;
    Ok(interval)
}
