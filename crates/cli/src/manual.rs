//! What an installed program gives a shell and `man`: completions and manual pages.

use std::fs;
use std::path::Path;

use clap::CommandFactory;
use clap_complete::Shell;
use creepage::Error;

use crate::commands::Line;
use crate::terminal::print;

/// Prints the completions for `shell`.
pub fn completions(shell: Shell) {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Line::command(), "creepage", &mut script);
    print(&script);
}

/// Prints the manual page (roff) of the program, or of its command `name`.
///
/// # Errors
/// A command that the program does not have.
pub fn page(name: Option<&str>) -> Result<(), Error> {
    let mut program = Line::command();
    // the options that all commands share, in the page of each
    program.build();
    let shown = match name {
        None => program,
        Some(name) => {
            let names =
                program.get_subcommands().map(|c| c.get_name()).collect::<Vec<_>>().join(", ");
            let command = program.find_subcommand(name).cloned().ok_or_else(|| Error::Option {
                problem: format!("there is no command {name}"),
                help: Some(format!("give one of {names}")),
            })?;
            command.display_name(format!("creepage-{name}"))
        }
    };
    let mut text = Vec::new();
    // a vector takes all that is written
    let _ = clap_mangen::Man::new(shown).render(&mut text);
    print(&text);
    Ok(())
}

/// Writes the manual pages of the program and of all its commands into `folder`, which is made if need be.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn pages(folder: &Path) -> Result<(), Error> {
    fs::create_dir_all(folder)
        .and_then(|()| clap_mangen::generate_to(Line::command(), folder))
        .map_err(|error| Error::Option {
            problem: format!("the pages cannot be written to {}: {error}", folder.display()),
            help: None,
        })
}
