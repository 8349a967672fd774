//! The guard of the element kernels' machine code: its instructions are counted, which repeats to the
//! digit where seconds do not.
//!
//! A closure or a function that is not inlined loses the enabled vector instructions and most of the
//! speed, and shows here as a call (the recorded ones clear arrays); code that grows shows as more
//! instructions. How many operations the
//! formulas themselves ask for is counted in the tests of `creepage-solid`.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// What the kernels of an instruction set came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Code {
    /// Compiled instances: element kind x energies x viscosity.
    instances: usize,
    instructions: usize,
    calls: usize,
}

/// Growth beyond the record that fails, in percent.
const ALLOWED: usize = 3;

/// What the guard found.
pub enum Verdict {
    /// All as recorded.
    Kept,
    /// Not comparable, and why.
    NotCompared(String),
    /// What is worse.
    Worse(Vec<String>),
}

/// Compares the kernels in `binary` with the `record`, lines of `level kernels instructions calls`
/// under a line with the compiler's version.
pub fn compare(binary: &Path, record: &Path) -> Result<Verdict, String> {
    let compiler = said(Command::new("rustc").arg("--version"))?;
    let disassembled =
        match said(Command::new("objdump").args(["-d", "--no-show-raw-insn"]).arg(binary)) {
            Ok(text) => text,
            Err(problem) => return Ok(Verdict::NotCompared(problem)),
        };
    let found = count(&disassembled);
    let text = std::fs::read_to_string(record)
        .map_err(|error| format!("{} cannot be read: {error}", record.display()))?;
    let mut worse = Vec::new();
    for (level, code) in &found {
        println!(
            "{level}: {} kernels, {} instructions, {} calls",
            code.instances, code.instructions, code.calls
        );
    }
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let recorded = lines.next().unwrap_or_default();
    if recorded.trim() != compiler.trim() {
        return Ok(Verdict::NotCompared(format!("recorded with {recorded}, this is {compiler}")));
    }
    for line in lines {
        let words: Vec<&str> = line.split_whitespace().collect();
        let numbers: Vec<usize> = words.iter().skip(1).map_while(|n| n.parse().ok()).collect();
        let (Some(&level), &[instances, instructions, calls]) = (words.first(), &numbers[..])
        else {
            return Err(format!(
                "{}: {line:?} is not `level kernels instructions calls`",
                record.display()
            ));
        };
        let code = found.get(level).copied().unwrap_or_default();
        if code.instances != instances {
            worse.push(format!("{level}: {} kernels instead of {instances}", code.instances));
        }
        if code.calls > calls {
            worse.push(format!("{level}: {} calls instead of {calls}", code.calls));
        }
        if 100 * code.instructions > (100 + ALLOWED) * instructions {
            let now = code.instructions;
            worse.push(format!("{level}: {now} instructions instead of {instructions}"));
        }
    }
    Ok(if worse.is_empty() { Verdict::Kept } else { Verdict::Worse(worse) })
}

/// The kernels of each level in a disassembly of the binary.
fn count(disassembled: &str) -> BTreeMap<&'static str, Code> {
    let mut found = BTreeMap::new();
    let mut level = None;
    for line in disassembled.lines() {
        if line.ends_with(">:") {
            level = ["avx512", "avx2"]
                .into_iter()
                .find(|name| line.contains(&format!("5solid5solid{}{name}3run17h", name.len())));
            if let Some(level) = level {
                found.entry(level).or_insert_with(Code::default).instances += 1;
            }
            continue;
        }
        // an instruction: address, tab, mnemonic
        let (Some(level), Some((_, instruction))) = (level, line.split_once(":\t")) else {
            continue;
        };
        let code = found.entry(level).or_insert_with(Code::default);
        let mnemonic = instruction.split_whitespace().next().unwrap_or_default();
        match mnemonic {
            // what fills the space up to the next function
            "int3" | "nop" | "nopw" | "nopl" | "cs" | "data16" | "xchg" => {}
            "call" | "callq" => code.calls += 1,
            _ => code.instructions += 1,
        }
    }
    found
}

fn said(command: &mut Command) -> Result<String, String> {
    match command.output() {
        Ok(output) if output.status.success() => {
            Ok(String::from_utf8_lossy(&output.stdout).into_owned())
        }
        Ok(output) => Err(format!("{command:?}: {}", output.status)),
        Err(error) => Err(format!("{command:?}: {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_and_calls_of_kernels_are_counted_and_nothing_else() {
        let text = "\
0000000000001000 <_ZN5solid5solid6avx5123run17h0123456789abcdefE>:
    1000:\tvmovapd (%rax),%zmm0
    1006:\tcall   2000 <_ZN4core3ops>
    100b:\tret
    100c:\tint3

0000000000002000 <_ZN4core3ops>:
    2000:\tret
0000000000003000 <_ZN5solid5solid4avx23run17h0123456789abcdefE.llvm.12>:
    3000:\tvmovapd (%rax),%ymm0
    3006:\tret
";
        let found = count(text);
        assert_eq!(found["avx512"], Code { instances: 1, instructions: 2, calls: 1 });
        assert_eq!(found["avx2"], Code { instances: 1, instructions: 2, calls: 0 });
    }
}
