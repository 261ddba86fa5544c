//! A study on disk of a ship in a current that its model does not contain, for the tests of the command.
//! The recordings are those of [`super::runs`].

use super::{model, runs, truth_noise};
use std::fmt::Write as _;
use std::path::Path;

/// Writes a study of `count` runs, every fourth a test run, of a ship in a current \[m/s\] that its model file does not contain.
pub fn write_study(folder: &Path, count: usize, [north, east]: [f64; 2]) {
    let base = model();
    let mut truth = base.clone();
    truth.add_term("current").unwrap();
    for (name, value) in [("current.north", north), ("current.east", east)] {
        let i = truth.find(name).unwrap();
        truth.parameters[i].value = value;
    }
    let mut table = "file,name,session,split\n".to_owned();
    for (i, run) in runs(&truth, &truth_noise(), count, 1).iter().enumerate() {
        let mut rows = "t [s],x [m],y [m],psi [rad],u [m/s],v [m/s],r [rad/s],n [rps],delta [rad]\n".to_owned();
        for (m, input) in run.measured.iter().zip(&run.inputs) {
            let [x, y, psi, u, v, r] = m.map(Option::unwrap);
            writeln!(rows, "{},{x},{y},{psi},{u},{v},{r},{},{}", input.t, input.n, input.delta).unwrap();
        }
        std::fs::write(folder.join(format!("{i}.csv")), rows).unwrap();
        let split = if i % 4 == 3 { "test" } else { "train" };
        writeln!(table, "{i}.csv,{},{},{split}", run.name, run.session).unwrap();
    }
    std::fs::write(folder.join("runs.csv"), table).unwrap();
    let ship = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/ships/a.toml");
    std::fs::copy(ship, folder.join("ship.toml")).unwrap();
    std::fs::write(folder.join("model.toml"), toml::to_string(&base.to_file()).unwrap()).unwrap();
    let study = "name = \"Concealed current\"\nship = \"ship.toml\"\nmodel = \"model.toml\"\ndata = \".\"\nruns = \"runs.csv\"\n\n[diagnose]\nseed = 7\n";
    std::fs::write(folder.join("study.toml"), study).unwrap();
}
