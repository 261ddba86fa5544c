//! Measures how memory and time of the commands grow with the recordings, from 10^4 to 10^8 recorded steps, and draws it.
//! It runs the command `trimtab` as a user does, on studies that it makes from a seed; no test depends on a number it finds.
//!
//! `stream_growth COMMAND STEPS [BINARY [FOLDER]]` measures one command at one size and adds it to `figures/growth.csv`; the
//! recordings are made for it, or are those that `stream_growth make FOLDER STEPS` made. `stream_growth draw` draws the table.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;
use std::error::Error;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use trimtab::model::Model;
use trimtab::report::plot::{Axis, BLUE, Color, Figure, GREEN, GREY, Layer, ORANGE, Panel, VERMILLION};
use trimtab::ship::Ship;
use trimtab::ship::state::Inputs;
use trimtab::simulate::{Integration, Scenario, simulate};

type Failure = Box<dyn Error + Send + Sync>;

/// Seed of the recordings.
const SEED: u64 = 20_250_226;

/// Sample period \[s\], rows of a recording and length of a window \[s\]: 41 windows of 120 steps a recording.
const DT: f64 = 2.0;
const ROWS: usize = 5000;
const WINDOW: f64 = 240.0;

/// Rows of a recording of the study that is diagnosed.
const DIAGNOSED: usize = 121;

/// The parameters of the ship that was recorded.
const STAR: [f64; 11] = [-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370];

/// The commands, and the colours in which they are drawn.
const COMMANDS: [(&str, Color); 5] =
    [("check", GREY), ("simulate", GREEN), ("evaluate", BLUE), ("fit", VERMILLION), ("diagnose", ORANGE)];

const HEADER: &str = "command,steps,processor_s,elapsed_s,microseconds_a_step,peak_megabytes,bytes_a_step";

fn main() -> Result<(), Failure> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = args.iter().map(String::as_str).collect();
    match words[..] {
        ["draw"] => draw(),
        ["make", folder, steps] => make(Path::new(folder), ROWS, size(steps)?),
        [command, steps] => measure(command, size(steps)?, &beside()?),
        [command, steps, binary] => measure(command, size(steps)?, Path::new(binary)),
        [command, steps, binary, folder] => {
            let study = study(Path::new(folder), command)?;
            note(command, size(steps)?, &run(Path::new(binary), command, &study)?)
        }
        _ => Err("give a command and a number of steps, or `draw`".into()),
    }
}

/// A number of steps, also as `1e6`.
fn size(text: &str) -> Result<usize, Failure> {
    Ok(text.parse::<f64>()? as usize)
}

/// The command built beside this program.
fn beside() -> Result<PathBuf, Failure> {
    let own = std::env::current_exe()?;
    let folder = own.parent().and_then(Path::parent).ok_or("no folder")?;
    Ok(folder.join("trimtab"))
}

fn table() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("figures/growth.csv")
}

/// Makes recordings, runs a command on them, and adds what it took to the table.
fn measure(command: &str, steps: usize, binary: &Path) -> Result<(), Failure> {
    let folder = std::env::temp_dir().join(format!("trimtab-growth-{}", std::process::id()));
    make(&folder, if command == "diagnose" { DIAGNOSED } else { ROWS }, steps)?;
    let taken = study(&folder, command).and_then(|study| run(binary, command, &study));
    std::fs::remove_dir_all(&folder)?;
    note(command, steps, &taken?)
}

/// Adds a line to the table, in place of an older one of the same command and size.
fn note(command: &str, steps: usize, taken: &Taken) -> Result<(), Failure> {
    let rows = steps as f64;
    let line = format!(
        "{command},{steps},{:.2},{:.2},{:.3},{:.1},{:.1}",
        taken.processor,
        taken.elapsed,
        1e6 * taken.processor / rows,
        taken.peak / 1e6,
        taken.peak / rows
    );
    println!("{HEADER}\n{line}");
    let old = std::fs::read_to_string(table()).unwrap_or_default();
    let key = format!("{command},{steps},");
    let mut lines: Vec<&str> = old.lines().skip(1).filter(|l| !l.starts_with(&key)).collect();
    lines.push(&line);
    let place = |l: &str| {
        let mut fields = l.split(',');
        let name = fields.next().unwrap_or_default();
        let steps: usize = fields.next().and_then(|s| s.parse().ok()).unwrap_or(0);
        (COMMANDS.iter().position(|(c, _)| *c == name), steps)
    };
    lines.sort_by_key(|l| place(l));
    Ok(std::fs::write(table(), format!("{HEADER}\n{}\n", lines.join("\n")))?)
}

/// What a run of a command took: time in s, memory in bytes.
struct Taken {
    processor: f64,
    elapsed: f64,
    peak: f64,
}

/// Runs a command and reads its processor time and its largest resident memory from `/proc`.
fn run(binary: &Path, command: &str, study: &Path) -> Result<Taken, Failure> {
    let began = Instant::now();
    let mut child = Command::new(binary).arg(command).arg(study).stdout(Stdio::null()).spawn()?;
    let proc = PathBuf::from(format!("/proc/{}", child.id()));
    let mut peak: f64 = 0.0;
    let processor = loop {
        let status = std::fs::read_to_string(proc.join("status"))?;
        let kilobytes = status.lines().find_map(|l| l.strip_prefix("VmHWM:")?.trim().strip_suffix("kB"));
        peak = peak.max(kilobytes.and_then(|k| k.trim().parse().ok()).unwrap_or(0.0) * 1024.0);
        // After the name in brackets: state, then eleven numbers, then ticks of a hundredth of a second in user and kernel mode.
        let stat = std::fs::read_to_string(proc.join("stat"))?;
        let fields: Vec<&str> = stat.rsplit(") ").next().unwrap_or_default().split(' ').collect();
        if fields.first() == Some(&"Z") {
            let ticks = |i: usize| fields.get(i).and_then(|f| f.parse::<f64>().ok()).unwrap_or(0.0);
            break 0.01 * (ticks(11) + ticks(12));
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let code = child.wait()?.code();
    // 1: the answer is no, such as a recording that `check` doubts.
    if !matches!(code, Some(0 | 1)) {
        return Err(format!("{command} ended with {code:?}").into());
    }
    Ok(Taken { processor, elapsed: began.elapsed().as_secs_f64(), peak })
}

/// Makes recordings of ship A with sensor noise under rudder and shaft orders drawn from the seed, two at least.
fn make(folder: &Path, rows: usize, steps: usize) -> Result<(), Failure> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/study/demo");
    std::fs::create_dir_all(folder.join("recordings"))?;
    for name in ["ship.toml", "model.toml", "baseline.toml"] {
        std::fs::copy(source.join(name), folder.join(name))?;
    }
    let mut model = Model::read(&source.join("model.toml"), Ship::read(&source.join("ship.toml"))?)?;
    model.set_eleven(&STAR);
    (0..(steps / rows).max(2)).into_par_iter().try_for_each(|i| {
        let path = folder.join(format!("recordings/{i}.csv"));
        std::fs::write(path, recording(&model, SEED + i as u64, rows)).map_err(Failure::from)
    })
}

/// Writes the study of a command on recordings that were made: a fit has all of them to train on, a diagnosis keeps a quarter
/// aside, whole, and the others half.
fn study(folder: &Path, command: &str) -> Result<PathBuf, Failure> {
    let count = std::fs::read_dir(folder.join("recordings"))?.count();
    let mut runs = BufWriter::new(File::create(folder.join(format!("{command}.csv")))?);
    writeln!(runs, "file,split")?;
    for i in 0..count {
        let train = match command {
            "fit" => true,
            "diagnose" => i % 4 > 0,
            _ => i % 2 == 0,
        };
        writeln!(runs, "recordings/{i}.csv,{}", if train { "train" } else { "test" })?;
    }
    runs.flush()?;
    let window = if command == "diagnose" { String::new() } else { format!("window = {WINDOW:?}\n") };
    let text = format!(
        "name = \"growth\"\nship = \"ship.toml\"\nmodel = \"model.toml\"\nruns = \"{command}.csv\"\n{window}\n\
         [fit.constraints]\nlimits = \"paper\"\n\n[evaluate]\nbaseline = \"baseline.toml\"\n"
    );
    let study = folder.join(format!("{command}.toml"));
    std::fs::write(&study, text)?;
    Ok(study)
}

/// One recording as CSV.
fn recording(model: &Model, seed: u64, rows: usize) -> String {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut n, mut delta, mut left) = (2.0, 0.0, [0_usize; 2]);
    let inputs: Vec<Inputs<f64>> = (0..rows)
        .map(|k| {
            if left[0] == 0 {
                (n, left[0]) = (rng.random_range(1.4..2.6), rng.random_range(60..300));
            }
            if left[1] == 0 {
                (delta, left[1]) = (rng.random_range(-0.4..0.4), rng.random_range(8..40));
            }
            left = left.map(|l| l - 1);
            Inputs::actuators(DT * k as f64, n, delta)
        })
        .collect();
    let scenario = Scenario { dt: DT, inputs: inputs.clone(), initial: [0.0, 0.0, 0.0, 4.0, 0.0, 0.0] };
    let states = simulate(model, &model.values(), Integration::default(), &scenario).states;
    let mut text = String::from("t [s],x [m],y [m],psi [rad],u [m/s],v [m/s],r [rad/s],n [rps],delta [rad]\n");
    for (i, s) in inputs.iter().zip(&states) {
        let mut noisy = |j: usize, sd: f64| s[j] + sd * rng.sample::<f64, _>(StandardNormal);
        let [x, y, psi] = [noisy(0, 0.5), noisy(1, 0.5), noisy(2, 0.002)];
        let [u, v, r] = [noisy(3, 0.02), noisy(4, 0.02), noisy(5, 3e-4)];
        let psi = psi.rem_euclid(std::f64::consts::TAU);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{},{x:.2},{y:.2},{psi:.4},{u:.3},{v:.3},{r:.5},{:.3},{:.4}", i.t, i.n, i.delta);
    }
    text
}

/// Draws time and memory of every command over the recorded steps.
fn draw() -> Result<(), Failure> {
    let text = std::fs::read_to_string(table())?;
    let numbers = |command: &str, column: usize| {
        let rows = text.lines().map(|l| l.split(',').collect::<Vec<_>>()).filter(|f| f[0] == command);
        rows.filter_map(|f| Some((f[1].parse().ok()?, f[column].parse().ok()?))).collect::<Vec<(f64, f64)>>()
    };
    let layers = |column: usize| {
        let of = |(command, color): &(&str, Color)| {
            let points = numbers(command, column);
            [Layer::line(*command, *color, points.clone()), Layer::scatter(*command, *color, points).unlisted()]
        };
        COMMANDS.iter().flat_map(of).collect::<Vec<_>>()
    };
    let axis = || Axis::new("recorded steps [-]").log();
    let limit = Layer::h_line("1 GB", GREY, 1000.0).dotted();
    let figure = Figure::new("Growth of the commands with the recordings")
        .columns(3)
        .with(Panel::new("processor time", axis(), Axis::new("time [s]").log()).with_all(layers(2)))
        .with(Panel::new("processor time a step", axis(), Axis::new("time [us]").log()).with_all(layers(4)))
        .with(
            Panel::new("largest resident memory", axis(), Axis::new("memory [MB]").log())
                .with_all(layers(5))
                .with(limit),
        );
    let path = table().with_extension("png");
    std::fs::write(&path, figure.png()?)?;
    println!("{}", path.display());
    Ok(())
}
