//! Fits a model to CSV recordings: `cargo run --release --example fit_csv -- ship.toml run_1.csv run_2.csv ...`
//! It needs no study file; without arguments it writes the built-in example to a temporary folder and fits that.

use std::error::Error;
use std::path::{Path, PathBuf};
use trimtab::{ColumnMap, FitSettings, Form, Labels, Model, Recording, Ship, Split, WindowSettings, fit, study::demo};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    if arguments.is_empty() {
        arguments = built_in()?;
    }
    let (ship, files) = arguments.split_first().ok_or("give a ship file and at least one recording")?;

    // Hull coefficients come from the main particulars, unless the ship file gives them; the paper's eleven are free.
    let ship = Ship::read(ship)?;
    let model = Model::new(ship.clone(), "from main particulars", Form::Regular, &[])?;

    // Columns are recognised by name and unit, as in `u [kn]`; any other layout is described by a ColumnMap.
    let settings = FitSettings::default();
    let mut runs = Vec::new();
    for file in files {
        let recording = Recording::read(file, &ColumnMap::default())?;
        let name = recording.name.clone();
        let labels = Labels { run: name.clone(), session: name, manoeuvre: String::new(), split: Split::Train };
        // Windows of four minutes: errors of a simulation grow with its length.
        let cut = WindowSettings { window: Some(240.0), ..WindowSettings::whole(ship.hull.draught) };
        runs.extend(recording.windows(&labels, &cut)?.windows);
    }

    let fitted = fit(&model, &runs, &settings, &mut |p| {
        eprintln!("iteration {}: cost {:.4}", p.iteration, p.cost);
        true
    })?;
    println!("{}", fitted.report());

    let path = std::env::temp_dir().join("trimtab_fitted.toml");
    std::fs::write(&path, toml::to_string(&fitted.model.to_file())?)?;
    println!("The model with its estimates is in {}: give it to any command as --model.", path.display());
    Ok(())
}

/// Writes ship and recordings of the built-in example, and says where.
fn built_in() -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let folder = std::env::temp_dir().join("trimtab_example");
    std::fs::create_dir_all(folder.join("recordings"))?;
    let mut files = vec![folder.join("ship.toml")];
    for (name, text) in demo::files() {
        std::fs::write(folder.join(&name), text)?;
        if Path::new(&name).starts_with("recordings") {
            files.push(folder.join(name));
        }
    }
    Ok(files)
}
