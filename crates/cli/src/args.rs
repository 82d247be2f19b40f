//! The command line: commands, flags, and the help text.

use std::net::IpAddr;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use catenix_export::{ExportFormat, Thinning};
use catenix_model::file::parse_band;
use catenix_model::{FormulationKind, ModeRange};
use catenix_report::Language;
use clap::builder::PossibleValue;
use clap::{Args, Parser, Subcommand, ValueEnum};

const EXIT_CODES: &str = "\
Exit codes:
    0  everything was computed
    1  the solver gave up in at least one load case, what was computed is kept; or a verification
       case failed
    2  the command line is wrong
    3  the model file is wrong
    4  a file could not be read or written
  130  interrupted; what was computed is kept";

/// Dynamics of kilometre-long pipes in the sea.
#[derive(Debug, Parser)]
#[command(name = "catenix", version, after_help = EXIT_CODES, max_term_width = 100)]
pub(crate) struct CommandLine {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Read a model file, report its errors, and print what it describes
    #[command(after_help = EXIT_CODES)]
    Check(CheckArgs),
    /// Find the static equilibrium of each load case
    #[command(after_help = EXIT_CODES)]
    Statics(StaticsArgs),
    /// Find the natural frequencies and mode shapes about the static equilibrium
    #[command(after_help = EXIT_CODES)]
    Modes(ModesArgs),
    /// Follow the equilibrium path of each load case as its loads are scaled
    #[command(after_help = EXIT_CODES)]
    Path(PathArgs),
    /// Compute the load cases, write the results and figures, and print a summary
    #[command(after_help = EXIT_CODES)]
    Run(RunArgs),
    /// Print the summary of results, also of an interrupted run
    #[command(after_help = EXIT_CODES)]
    Summary(SummaryArgs),
    /// Export results as tables, for ParaView, or as NetCDF
    #[command(after_help = EXIT_CODES)]
    Export(ExportArgs),
    /// Write a report of results: one HTML file to read and to print
    #[command(after_help = EXIT_CODES)]
    Report(ReportArgs),
    /// Compute published cases and hold them against their references
    #[command(after_help = EXIT_CODES)]
    Verify(VerifyArgs),
    /// Compute load cases under several formulations, and print differences, errors and costs
    #[command(after_help = EXIT_CODES)]
    Compare(CompareArgs),
    /// Show results in the browser, also while a run writes them
    #[command(after_help = EXIT_CODES)]
    View(ViewArgs),
    /// Print the JSON schema of the model file, for editors
    Schema,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct StaticsArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) work: WorkArgs,
    #[command(flatten)]
    pub(crate) accuracy: AccuracyArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ModesArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Find this many modes, the lowest [default: as `modes` in the model file says, or 10]
    #[arg(long, value_name = "N")]
    pub(crate) count: Option<NonZeroUsize>,
    /// Find all modes in a band of frequencies, such as "0.1 Hz..2 Hz"
    #[arg(long, value_name = "FROM..TO", conflicts_with = "count", value_parser = parse_band)]
    pub(crate) band: Option<ModeRange>,
    /// Leave the added mass of the water out, about the same equilibrium
    #[arg(long)]
    pub(crate) air: bool,
    /// Directory for results.zarr with the shapes, and figures of them; earlier results in it are
    /// replaced [default: nothing is written]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) work: WorkArgs,
}

#[derive(Debug, Args)]
pub(crate) struct PathArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Write all points with all channels into this file, as comma-separated values
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Draw the factor against a channel into this file: SVG, or PNG where the name ends so
    #[arg(long, value_name = "FILE")]
    pub(crate) figure: Option<PathBuf>,
    /// Channel of the figure [default: the first that the model file asks for]
    #[arg(long, value_name = "NAME", requires = "figure")]
    pub(crate) channel: Option<String>,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) work: WorkArgs,
}

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Directory for results.zarr, summary.json and figures; earlier results in it are replaced
    /// [default: `results/` and the name of the model file]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) live: LiveArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) work: WorkArgs,
    #[command(flatten)]
    pub(crate) accuracy: AccuracyArgs,
}

/// Where the viewer of a run listens.
#[derive(Debug, Args)]
pub(crate) struct LiveArgs {
    /// Show the results in the browser while they are computed, and until Ctrl-C
    #[arg(long)]
    pub(crate) live: bool,
    /// Port of the viewer [default: any that is free]
    #[arg(long, value_name = "PORT", requires = "live")]
    pub(crate) port: Option<u16>,
    /// Print the viewer's address without opening the browser
    #[arg(long, requires = "live")]
    pub(crate) no_open: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    /// Directory that `catenix run` wrote, or the results.zarr in it
    #[arg(value_name = "RESULTS")]
    pub(crate) results: PathBuf,
    #[command(flatten)]
    pub(crate) listen: ListenArgs,
}

/// Where a viewer listens.
#[derive(Debug, Args)]
pub(crate) struct ListenArgs {
    /// Port [default: any that is free]
    #[arg(long, value_name = "PORT")]
    pub(crate) port: Option<u16>,
    /// Address to listen on, for viewing from another machine [default: this machine only]
    #[arg(long, value_name = "IP")]
    pub(crate) address: Option<IpAddr>,
    /// Print the address without opening the browser
    #[arg(long)]
    pub(crate) no_open: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SummaryArgs {
    /// Directory that `catenix run` wrote, or the results.zarr in it
    #[arg(value_name = "RESULTS")]
    pub(crate) results: PathBuf,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    /// Directory that `catenix run` wrote, or the results.zarr in it
    #[arg(value_name = "RESULTS")]
    pub(crate) results: PathBuf,
    /// File format: tables as csv or parquet, series of poly-data as vtk, one netcdf file per case
    #[arg(long, value_name = "FORMAT")]
    pub(crate) to: FormatArg,
    /// Directory for the files [default: `export/` and the format, beside results.zarr]
    #[arg(long, short, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Take only this load case; may be given several times
    #[arg(long = "case", value_name = "NAME")]
    pub(crate) cases: Vec<String>,
    /// Take only this line, and all vessels, bodies and channels; may be given several times
    #[arg(long = "line", value_name = "NAME")]
    pub(crate) lines: Vec<String>,
    /// Take the first stored row and every N-th after it
    #[arg(long, value_name = "N", conflicts_with = "times")]
    pub(crate) every: Option<NonZeroUsize>,
    /// Take the stored rows from one time to another, in seconds; with a step, those nearest to it
    #[arg(long, value_name = "FROM:TO[:STEP]", allow_hyphen_values = true)]
    pub(crate) times: Option<Thinning>,
    /// Write every quantity at every node and time too, one row each (csv and parquet)
    #[arg(long)]
    pub(crate) fields: bool,
    /// Replace files of an earlier export
    #[arg(long)]
    pub(crate) force: bool,
    /// Show no progress
    #[arg(long, short)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

/// File formats of an export, by their words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FormatArg(pub(crate) ExportFormat);

impl ValueEnum for FormatArg {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [FormatArg; 4] = [
            FormatArg(ExportFormat::Csv),
            FormatArg(ExportFormat::Parquet),
            FormatArg(ExportFormat::Vtk),
            FormatArg(ExportFormat::Netcdf),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.word()))
    }
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Directory that `catenix run` or `catenix modes` wrote, or the results.zarr in it
    #[arg(value_name = "RESULTS")]
    pub(crate) results: PathBuf,
    /// File to write, replaced if it exists [default: report.html beside results.zarr]
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Language: en or zh (English, Chinese)
    #[arg(long, value_name = "LANG", default_value = "en")]
    pub(crate) lang: Language,
    /// Write every figure as SVG and PNG into this directory too
    #[arg(long, value_name = "DIR")]
    pub(crate) figures: Option<PathBuf>,
    /// Take templates from this directory instead of the built-in ones of the same name
    #[arg(long, value_name = "DIR")]
    pub(crate) templates: Option<PathBuf>,
    /// Print one JSON document; errors are part of it
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct VerifyArgs {
    /// Take only this case; may be given several times
    #[arg(long = "case", value_name = "NAME")]
    pub(crate) cases: Vec<String>,
    /// Formulation of lines: dem, fem, fem-exact, lumped, or all of them
    #[arg(long, value_enum, value_name = "NAME", default_value = "dem")]
    pub(crate) formulation: FormulationArg,
    /// Folder of verification cases [default: the suite that is part of the program]
    #[arg(long, value_name = "DIR")]
    pub(crate) suite: Option<PathBuf>,
    /// Write a page with tables and plots into this directory
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Only print names and titles of the cases
    #[arg(long)]
    pub(crate) list: bool,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) work: WorkArgs,
}

/// One formulation, or all.
#[derive(Debug, Clone, Copy)]
pub(crate) enum FormulationArg {
    One(FormulationKind),
    All,
}

impl FormulationArg {
    /// The formulations that are meant.
    pub(crate) fn kinds(self) -> Vec<FormulationKind> {
        match self {
            FormulationArg::One(kind) => vec![kind],
            FormulationArg::All => FormulationKind::ALL.to_vec(),
        }
    }
}

impl ValueEnum for FormulationArg {
    fn value_variants<'a>() -> &'a [Self] {
        const KINDS: usize = FormulationKind::ALL.len();
        const VARIANTS: [FormulationArg; KINDS + 1] = {
            let mut variants = [FormulationArg::All; KINDS + 1];
            let mut k = 0;
            while k < KINDS {
                variants[k] = FormulationArg::One(FormulationKind::ALL[k]);
                k += 1;
            }
            variants
        };
        &VARIANTS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(match self {
            FormulationArg::One(kind) => kind.word(),
            FormulationArg::All => "all",
        }))
    }
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Model file (TOML)
    #[arg(value_name = "MODEL")]
    pub(crate) file: PathBuf,
    /// Take only this load case; may be given several times
    #[arg(long = "case", value_name = "NAME")]
    pub(crate) cases: Vec<String>,
    /// Formulations to compare
    #[arg(
        long,
        value_name = "KIND,..",
        value_delimiter = ',',
        value_parser = formulation,
        default_value = "dem,fem,lumped"
    )]
    pub(crate) formulations: Vec<FormulationKind>,
    /// Formulation of the fine computation that errors are measured against [default: the first]
    #[arg(long, value_name = "KIND", value_parser = formulation)]
    pub(crate) reference: Option<FormulationKind>,
    /// Elements of the meshes, over those of the model file
    #[arg(
        long,
        value_name = "FACTOR,..",
        value_delimiter = ',',
        value_parser = positive,
        default_value = "0.125,0.25,0.5,1,2"
    )]
    pub(crate) meshes: Vec<f64>,
    /// Elements of the reference, over those of the model file; its steps are half as long
    #[arg(long, value_name = "FACTOR", value_parser = positive, default_value = "4")]
    pub(crate) reference_mesh: f64,
    /// Error at which costs are compared
    #[arg(long, value_name = "PERCENT", value_parser = percent, default_value = "1%")]
    pub(crate) target: f64,
    /// Draw cost against error, one figure per load case, into this directory
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    /// Show no progress
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ModelArgs {
    /// Model file (TOML)
    #[arg(value_name = "MODEL")]
    pub(crate) file: PathBuf,
    /// Take only this load case; may be given several times
    #[arg(long = "case", value_name = "NAME")]
    pub(crate) cases: Vec<String>,
    /// Formulation of the lines: dem, fem, fem-exact or lumped [default: as the model file says]
    #[arg(long, value_name = "KIND", value_parser = formulation)]
    pub(crate) formulation: Option<FormulationKind>,
}

#[derive(Debug, Args)]
pub(crate) struct OutputArgs {
    /// Print one JSON document instead of tables; errors are part of it
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct WorkArgs {
    /// Load cases computed at once [default: as many as there are processors]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Show no progress
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct AccuracyArgs {
    /// Choose element lengths and time step so that the estimated error of every headline result
    /// stays below this, and print the estimates; instead of those in the model file
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub(crate) accuracy: Option<f64>,
}

/// A formulation by its word in the model file.
fn formulation(text: &str) -> Result<FormulationKind, String> {
    let word = text.trim();
    let known = FormulationKind::ALL
        .into_iter()
        .find(|kind| kind.word() == word);
    known.ok_or_else(|| {
        let words = FormulationKind::ALL.map(FormulationKind::word);
        format!("write one of {}", words.join(", "))
    })
}

/// A positive number.
fn positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("write a positive number such as 0.5".to_owned()),
    }
}

/// A relative error: `1%`, `0.5 %` or `0.01`.
fn percent(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    match number.trim().parse::<f64>() {
        Ok(value) if (1e-6..=0.2).contains(&(value * unit)) => Ok(value * unit),
        Ok(_) => Err("between 0.0001% and 20%".to_owned()),
        Err(_) => Err("write a share such as 1% or 0.01".to_owned()),
    }
}
