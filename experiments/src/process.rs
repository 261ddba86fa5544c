//! Runs a program, each time as a process of its own with a time limit.
//! It reads nothing of what the program says.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::conceal::error::ConcealError;

/// What a process left.
#[derive(Debug, Clone, PartialEq)]
pub struct Ended {
    /// Exit code; `None` if a signal ended it.
    pub code: Option<i32>,
    /// Whether it was stopped at the time limit.
    pub stopped: bool,
    /// Standard output.
    pub output: String,
    /// Standard error.
    pub messages: String,
    /// Time it took \[s\].
    pub seconds: f64,
}

/// Refuses a program that is not there.
///
/// # Errors
/// [`ConcealError::Content`] with what to do.
pub fn is_there(tool: &Path) -> Result<(), ConcealError> {
    let message = "there is no such program; build it with `cargo build --release`, or give its path with --tool";
    if tool.is_file() { Ok(()) } else { Err(ConcealError::content(tool, &message)) }
}

/// Runs a command to its end, at most `limit`.
///
/// # Errors
/// If it cannot be started or its output cannot be read.
pub fn run(mut command: Command, limit: Duration) -> io::Result<Ended> {
    // Output goes through files: a full pipe without a reader would stop the program.
    let (mut out, mut err) = (tempfile::tempfile()?, tempfile::tempfile()?);
    // A program that is started from a rank is no rank itself.
    for (name, _) in std::env::vars_os() {
        if ["OMPI_", "PMIX_", "PMI_"].iter().any(|launcher| name.to_string_lossy().starts_with(launcher)) {
            command.env_remove(name);
        }
    }
    let began = Instant::now();
    let mut child = command.stdin(Stdio::null()).stdout(out.try_clone()?).stderr(err.try_clone()?).spawn()?;
    let mut stopped = false;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if began.elapsed() > limit {
            stopped = true;
            child.kill()?;
            break child.wait()?;
        }
        std::thread::sleep(Duration::from_millis(10));
    };
    let seconds = began.elapsed().as_secs_f64();
    Ok(Ended { code: status.code(), stopped, output: text(&mut out)?, messages: text(&mut err)?, seconds })
}

fn text(file: &mut File) -> io::Result<String> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    file.read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// As [`run`], where exit code 1 is an answer and everything else but 0 a failure.
///
/// # Errors
/// [`ConcealError`] with the program's last message, or that it was stopped.
pub fn answer(command: Command, program: &Path, limit: Duration) -> Result<Ended, ConcealError> {
    let ended = run(command, limit).map_err(|source| ConcealError::file(program, source))?;
    let message = match ended.code {
        _ if ended.stopped => format!("stopped after {} s", limit.as_secs()),
        Some(0 | 1) => return Ok(ended),
        Some(code) => format!("exit status {code}: {}", ended.messages.lines().last().unwrap_or_default()),
        None => "ended by a signal".to_owned(),
    };
    Err(ConcealError::content(program, &message))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn command(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.arg("-c").arg(script);
        command
    }

    fn shell(script: &str, limit: Duration) -> Ended {
        run(command(script), limit).unwrap()
    }

    #[test]
    fn exit_code_1_is_an_answer_and_exit_code_2_an_error_with_its_message() {
        let of = |script: &str| answer(command(script), Path::new("sh"), Duration::from_secs(20));
        assert_eq!(of("echo no; exit 1").unwrap().output, "no\n");
        let e = of("echo first >&2; echo last >&2; exit 2").unwrap_err().to_string();
        assert!(e.contains("exit status 2") && e.ends_with("last"), "{e}");
    }

    #[test]
    fn an_answer_that_does_not_come_in_time_is_an_error() {
        let e = answer(command("exec sleep 60"), Path::new("sh"), Duration::ZERO).unwrap_err().to_string();
        assert!(e.contains("stopped after"), "{e}");
    }

    #[test]
    fn a_process_leaves_its_code_and_both_outputs() {
        let ended = shell("echo said; echo told >&2; exit 2", Duration::from_secs(20));
        assert_eq!((ended.code, ended.stopped), (Some(2), false));
        assert_eq!((ended.output.as_str(), ended.messages.as_str()), ("said\n", "told\n"));
    }

    #[test]
    fn a_program_that_is_not_there_is_refused_with_what_to_do() {
        let refused = is_there(Path::new("nowhere/trimtab")).unwrap_err().to_string();
        assert!(refused.contains("nowhere/trimtab") && refused.contains("cargo build --release"), "{refused}");
    }

    #[test]
    fn a_process_that_does_not_end_is_stopped_and_one_that_cannot_start_is_an_error() {
        let ended = shell("exec sleep 60", Duration::ZERO);
        assert!(ended.stopped && ended.code.is_none() && ended.seconds < 20.0);
        let missing = run(Command::new("no-such-program"), Duration::ZERO);
        assert!(missing.is_err());
    }
}
