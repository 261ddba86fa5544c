//! A figure as an image or a file: PNG, SVG, and the CSV behind them.
//! How it is laid out is in `layout`, and how an image is made in `raster` and `svg`.

use super::drawing::layout::draw;
use super::error::FigureError;
use super::figure::Figure;
use super::sheet::{pdf, raster, svg};
use crate::files::write_whole;
use std::path::{Path, PathBuf};

/// A kind of image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Pixels, 192 to an inch.
    Png,
    /// Vectors for the web.
    Svg,
    /// Vectors for print, its letters embedded.
    Pdf,
}

impl Format {
    /// How file names end.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Pdf => "pdf",
        }
    }
}

impl Figure {
    /// The figure as the bytes of a file.
    ///
    /// # Errors
    /// As [`Self::png`], [`Self::svg`] and [`Self::pdf`].
    pub fn image(&self, format: Format) -> Result<Vec<u8>, FigureError> {
        match format {
            Format::Png => self.png(),
            Format::Svg => self.svg().map(String::into_bytes),
            Format::Pdf => self.pdf(),
        }
    }

    /// The figure as a PDF of one page of its size, without a date.
    ///
    /// # Errors
    /// [`FigureError::Font`] if the program is damaged.
    pub fn pdf(&self) -> Result<Vec<u8>, FigureError> {
        pdf::pdf(&draw(self))
    }

    /// The figure as PNG, meant to be shown at half its size in px.
    ///
    /// # Errors
    /// [`FigureError::TooLarge`] above 40 million pixels; [`FigureError::Font`], [`FigureError::Drawing`] and
    /// [`FigureError::Png`] if the program is damaged.
    pub fn png(&self) -> Result<Vec<u8>, FigureError> {
        raster::png(&draw(self))
    }

    /// The figure as an SVG document without external references.
    ///
    /// # Errors
    /// [`FigureError::Font`] and [`FigureError::Drawing`] if the program is damaged.
    pub fn svg(&self) -> Result<String, FigureError> {
        svg::svg(&draw(self))
    }

    /// Writes `stem.png` and `stem.csv`, making the folder if need be, and returns their paths.
    ///
    /// # Errors
    /// [`FigureError::Io`] if a file cannot be written, and as [`Self::png`] and [`Self::csv`].
    pub fn save(&self, stem: &Path) -> Result<Vec<PathBuf>, FigureError> {
        self.save_as(stem, &[Format::Png])
    }

    /// Writes the figure in some formats and `stem.csv`, as [`Self::save`].
    ///
    /// # Errors
    /// As [`Self::save`] and [`Self::image`].
    pub fn save_as(&self, stem: &Path, formats: &[Format]) -> Result<Vec<PathBuf>, FigureError> {
        let images = formats.iter().map(|f| write(stem, f.extension(), &self.image(*f)?));
        images.chain([self.csv().and_then(|csv| write(stem, "csv", csv.as_bytes()))]).collect()
    }
}

fn write(stem: &Path, extension: &str, bytes: &[u8]) -> Result<PathBuf, FigureError> {
    // Appended, not replaced: a stem may have dots of its own.
    let mut name = stem.as_os_str().to_owned();
    name.push(".");
    name.push(extension);
    let path = PathBuf::from(name);
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| FigureError::Io { path, source }
    };
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(failed(folder))?;
    }
    write_whole(&path, bytes).map_err(failed(&path))?;
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plot::axis::Axis;
    use crate::report::plot::figure::{Legend, Panel};
    use crate::report::plot::layer::{Layer, Marker};
    use crate::report::plot::palette::{BLUE, GREEN, TRUTH};

    const NAN: f64 = f64::NAN;

    /// Every kind of layer over the same numbers.
    fn every_layer(v: &[f64]) -> Vec<Layer> {
        let pairs = || v.iter().enumerate().map(|(i, &y)| (i as f64, y));
        let mut layers = vec![
            Layer::line("line", TRUTH, pairs()),
            Layer::line("dashed", BLUE, pairs()).dashed(),
            Layer::line("dotted", BLUE, pairs()).dotted().width(6.0),
            Layer::errors("errors", GREEN, pairs().map(|(x, y)| (x, y, y - 1.0, y + 1.0))),
            Layer::band("band", BLUE, pairs().map(|(x, y)| (x, y - 1.0, y + 1.0))),
            Layer::h_span("h-span", GREEN, f64::NEG_INFINITY, v.first().copied().unwrap_or(NAN)),
            Layer::v_span("v-span", GREEN, 0.0, f64::INFINITY),
            Layer::h_line("h-line", TRUTH, v.first().copied().unwrap_or(NAN)),
            Layer::v_line("v-line", TRUTH, v.last().copied().unwrap_or(NAN)),
            Layer::bars("bars", BLUE, v.iter().copied()),
            Layer::bars_with_intervals("intervals", BLUE, v.iter().map(|&y| (y, y - 1.0, y + 1.0))),
            Layer::boxes("boxes", BLUE, [v.to_vec(), vec![], vec![NAN], vec![1.0]]),
            Layer::hulls("hulls", TRUTH, v.iter().map(|&y| [y, 2.0 * y, 0.1 * y]), 80.0, 12.0),
            Layer::arrows("arrows", TRUTH, pairs().map(|p| [p, (p.0 + 1.0, p.1 + 1.0)])),
            Layer::heatmap("heatmap", vec![v.to_vec(), vec![], vec![NAN, 1.0]]),
            Layer::text("a remark", TRUTH, (0.0, v.first().copied().unwrap_or(NAN))),
        ];
        for marker in [Marker::Circle, Marker::Square, Marker::Diamond, Marker::Triangle, Marker::Cross] {
            layers.push(Layer::scatter("scatter", GREEN, pairs()).marker(marker));
        }
        layers
    }

    fn samples() -> Vec<Vec<f64>> {
        vec![
            (0..40).map(|i| f64::from(i).sin() * 3.0).collect(),
            vec![],
            vec![2.5],
            vec![4.0; 12],
            vec![0.0; 3],
            vec![1.0, NAN, 3.0, f64::INFINITY, f64::NEG_INFINITY, 2.0, -1.0],
            vec![NAN; 4],
            vec![1e-300, 1e300, -1e299, 5e299, f64::MAX, f64::MIN_POSITIVE],
        ]
    }

    #[test]
    fn every_layer_draws_on_normal_empty_single_constant_missing_and_extreme_data() {
        let axes = |label: &str| {
            [
                Axis::new(label),
                Axis::new(label).log(),
                Axis::categories(label, ["first", "a second one of some length", "third"]),
                Axis::categories(label, Vec::<String>::new()),
                Axis::new(label).range(2.0, -1.0).every(0.5),
            ]
        };
        for values in samples() {
            for layer in every_layer(&values) {
                let panels = axes("x [m]").into_iter().zip(axes("y [m]").into_iter().rev()).map(|(x, y)| {
                    let mut panel = Panel::new(layer.name.clone(), x, y).with(layer.clone());
                    panel.equal_aspect = true;
                    panel
                });
                let figure = Figure::new("every layer").with_all(panels).columns(5).panel_size(300, 200);
                let svg = figure.svg().unwrap();
                assert!(!svg.contains("NaN") && !svg.contains("inf"), "{} {values:?}", layer.name);
                assert!(!figure.csv().unwrap().contains("NaN"));
            }
            let figure = Figure::new("all").with(Panel::default().with_all(every_layer(&values)));
            assert!(figure.png().unwrap().starts_with(b"\x89PNG"));
            assert!(figure.pdf().unwrap().starts_with(b"%PDF"));
        }
    }

    #[test]
    fn a_panel_without_data_says_so() {
        let says = |layers: Vec<Layer>| {
            let svg = Figure::new("").with(Panel::default().with_all(layers)).svg().unwrap();
            svg.contains("\nno data\n")
        };
        assert!(says(vec![]));
        assert!(says(vec![Layer::line("a", TRUTH, [(1.0, NAN), (NAN, 2.0)]), Layer::h_line("limit", TRUTH, 3.0)]));
        assert!(!says(vec![Layer::line("a", TRUTH, [(1.0, 2.0)])]));
        assert!(Figure::new("").png().unwrap().starts_with(b"\x89PNG"));
    }

    #[test]
    fn a_missing_value_breaks_the_line() {
        let lines = |points: Vec<(f64, f64)>| {
            let svg = Figure::new("")
                .legend(Legend::Off)
                .with(Panel::default().with(Layer::line("", BLUE, points)))
                .svg()
                .unwrap();
            svg.lines().filter(|l| l.starts_with("<polyline") && l.contains("#0072B2")).count()
        };
        assert_eq!(lines(vec![(0.0, 1.0), (1.0, 2.0), (2.0, 3.0), (3.0, 1.0)]), 1);
        assert_eq!(lines(vec![(0.0, 1.0), (1.0, 2.0), (1.5, NAN), (2.0, 3.0), (3.0, 1.0)]), 2);
    }

    #[test]
    fn the_same_figure_gives_the_same_bytes() {
        let figure = Figure::new("ψ").with(Panel::default().with_all(every_layer(&samples()[0])));
        assert_eq!(figure.png().unwrap(), figure.png().unwrap());
        assert_eq!(figure.svg().unwrap(), figure.svg().unwrap());
        assert_eq!(figure.pdf().unwrap(), figure.pdf().unwrap());
    }

    #[test]
    fn files_are_written_beside_each_other_and_failures_name_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let figure = Figure::new("").with(Panel::default());
        let paths = figure.save(&folder.path().join("new/fig.3a")).unwrap();
        assert_eq!(paths, [folder.path().join("new/fig.3a.png"), folder.path().join("new/fig.3a.csv")]);
        assert!(paths.iter().all(|p| p.exists()));
        let error = figure.save(&paths[0].join("inside-a-file")).unwrap_err();
        assert!(error.to_string().contains("fig.3a.png"), "{error}");
    }
}
