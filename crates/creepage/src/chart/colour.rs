//! Colours (red, green, blue; 0 to 255) that stay apart for the colour-blind (Okabe and Ito 2008).

/// White, of the paper.
pub const WHITE: [u8; 3] = [255; 3];
/// Black.
pub const BLACK: [u8; 3] = [0, 0, 0];
/// Grey, for bounds and references.
pub const GREY: [u8; 3] = [130, 130, 130];
/// Blue.
pub const BLUE: [u8; 3] = [0, 114, 178];
/// Vermilion.
pub const VERMILION: [u8; 3] = [213, 94, 0];
/// Bluish green.
pub const GREEN: [u8; 3] = [0, 158, 115];
/// Reddish purple.
pub const PURPLE: [u8; 3] = [204, 121, 167];
/// Orange.
pub const ORANGE: [u8; 3] = [230, 159, 0];
