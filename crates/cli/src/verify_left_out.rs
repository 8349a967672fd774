//! `creepage verify` in a program that was built without the feature `verify`.

use creepage::Error;

use crate::args::Args;

/// Whatever options the command is given.
#[derive(Debug, clap::Args)]
pub struct VerifyArgs {
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

/// Refuses the command.
///
/// # Errors
/// Always, with the command that builds the program with it.
pub fn command(_: &Args, _: &VerifyArgs) -> Result<u8, Error> {
    Err(Error::Option {
        problem: "this program was built without `creepage verify`".to_owned(),
        help: Some("`cargo build --release` builds it with all commands".to_owned()),
    })
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::commands::{Line, dispatch};

    #[test]
    fn verify_is_refused_with_the_command_that_builds_it_whatever_its_options() {
        for words in ["verify", "verify --list", "verify hertz-wheel --quick --plot figures"] {
            let words = ["creepage"].into_iter().chain(words.split(' '));
            let error = dispatch(&Line::try_parse_from(words).unwrap()).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            let Error::Option { problem, help: Some(help) } = error else { panic!("{error}") };
            assert_eq!(problem, "this program was built without `creepage verify`");
            assert!(help.contains("cargo build --release"), "{help}");
        }
    }
}
