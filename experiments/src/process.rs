//! Runs the program that diagnoses, each time as a process of its own with a time limit.
//! It reads nothing of what the program says.

use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::error::InjectedError;

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

/// Runs a command to its end, at most `limit`.
///
/// # Errors
/// [`InjectedError::Case`] if it cannot be started or its output cannot be read.
pub fn run(mut command: Command, program: &Path, limit: Duration) -> Result<Ended, InjectedError> {
    let fail = |source| InjectedError::file(program, source);
    // Output goes through files: a full pipe without a reader would stop the program.
    let (mut out, mut err) = (tempfile::tempfile().map_err(fail)?, tempfile::tempfile().map_err(fail)?);
    let copy = |file: &std::fs::File| file.try_clone().map(Stdio::from).map_err(fail);
    let began = Instant::now();
    let mut child = command.stdin(Stdio::null()).stdout(copy(&out)?).stderr(copy(&err)?).spawn().map_err(fail)?;
    let mut stopped = false;
    let status = loop {
        if let Some(status) = child.try_wait().map_err(fail)? {
            break status;
        }
        if began.elapsed() > limit {
            stopped = true;
            child.kill().map_err(fail)?;
            break child.wait().map_err(fail)?;
        }
        std::thread::sleep(Duration::from_millis(10));
    };
    let text = |file: &mut std::fs::File| -> Result<String, InjectedError> {
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(0)).map_err(fail)?;
        file.read_to_end(&mut bytes).map_err(fail)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    };
    Ok(Ended {
        code: status.code(),
        stopped,
        output: text(&mut out)?,
        messages: text(&mut err)?,
        seconds: began.elapsed().as_secs_f64(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str, limit: Duration) -> Ended {
        let mut command = Command::new("sh");
        command.arg("-c").arg(script);
        run(command, Path::new("sh"), limit).unwrap()
    }

    #[test]
    fn a_process_leaves_its_code_and_both_outputs() {
        let ended = shell("echo said; echo told >&2; exit 2", Duration::from_secs(20));
        assert_eq!((ended.code, ended.stopped), (Some(2), false));
        assert_eq!((ended.output.as_str(), ended.messages.as_str()), ("said\n", "told\n"));
    }

    #[test]
    fn a_process_that_does_not_end_is_stopped_and_one_that_cannot_start_is_an_error() {
        let ended = shell("exec sleep 60", Duration::ZERO);
        assert!(ended.stopped && ended.code.is_none() && ended.seconds < 20.0);
        let missing = run(Command::new("no-such-program"), Path::new("no-such-program"), Duration::ZERO);
        assert!(missing.is_err());
    }
}
