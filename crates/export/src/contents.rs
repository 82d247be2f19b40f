//! What there is to export of one load case: the rows that were written and are wanted.

use catenix_results::{CaseDescription, LinePlace, Status, StoredCase};

use crate::{ExportError, Thinning};

/// One load case with the wanted rows and lines.
#[derive(Debug)]
pub(crate) struct CaseContents {
    pub(crate) stored: StoredCase,
    pub(crate) description: CaseDescription,
    /// Wanted rows of the histories, and their times [s].
    pub(crate) history_rows: Vec<usize>,
    pub(crate) history_times_s: Vec<f64>,
    /// Wanted rows of the fields, and their times [s].
    pub(crate) field_rows: Vec<usize>,
    pub(crate) field_times_s: Vec<f64>,
    /// Wanted lines.
    pub(crate) lines: Vec<LinePlace>,
    /// All lines that there are.
    pub(crate) line_names: Vec<String>,
}

impl CaseContents {
    /// Looks at a case as it is now. Rows that a running solver adds later are left out, so that all
    /// files end at the same time.
    pub(crate) fn read(
        stored: StoredCase,
        lines: &[String],
        thinning: &Thinning,
    ) -> Result<Self, ExportError> {
        let mut description = stored.describe()?;
        let progress = &description.progress;
        let all = |count: usize| (0..count).collect::<Vec<_>>();
        let history = match &description.time {
            Some(place) => {
                let rows = all(progress.history_rows.min(place.rows));
                stored.history_time()?.read(&rows)?
            }
            None => Vec::new(),
        };
        let fields = match description.lines.first() {
            Some(line) => {
                let rows = all(progress.field_rows.min(line.field_time.rows));
                stored.field_time(&line.name)?.read(&rows)?
            }
            None => Vec::new(),
        };
        let names = description.lines.iter().map(|line| line.name.clone());
        let line_names = names.collect();
        let wanted = |line: &LinePlace| lines.is_empty() || lines.contains(&line.name);
        let lines = description
            .lines
            .extract_if(.., |line| wanted(line))
            .collect();
        let history_rows = thinning.rows(&history);
        let field_rows = thinning.rows(&fields);
        let times = |rows: &[usize], times: &[f64]| rows.iter().map(|row| times[*row]).collect();
        let contents = CaseContents {
            history_times_s: times(&history_rows, &history),
            field_times_s: times(&field_rows, &fields),
            history_rows,
            field_rows,
            lines,
            line_names,
            stored,
            description,
        };
        contents.refuse_empty_stretch(thinning, &history)?;
        Ok(contents)
    }

    pub(crate) fn name(&self) -> &str {
        self.stored.name()
    }

    pub(crate) fn status(&self) -> Status {
        self.description.progress.status
    }

    /// Whether not even a static state was stored.
    pub(crate) fn is_empty(&self) -> bool {
        self.description.time.is_none()
            || self.description.progress.history_rows == 0 && {
                let has_static = |line: &LinePlace| {
                    let mut quantities = line.quantities.iter();
                    quantities.any(|quantity| quantity.static_state.is_some())
                };
                !self.lines.iter().any(has_static)
            }
    }

    /// Values of all fields of the wanted lines at one time.
    pub(crate) fn field_values(&self) -> usize {
        let values = |line: &LinePlace| line.arc_length.rows * line.quantities.len();
        self.lines.iter().map(values).sum()
    }

    fn refuse_empty_stretch(&self, thinning: &Thinning, times: &[f64]) -> Result<(), ExportError> {
        match (thinning, times.first(), times.last()) {
            (Thinning::Times { from_s, to_s, .. }, Some(first_s), Some(last_s))
                if self.history_rows.is_empty() =>
            {
                Err(ExportError::NoRows {
                    case: self.name().to_owned(),
                    from_s: *from_s,
                    to_s: *to_s,
                    first_s: *first_s,
                    last_s: *last_s,
                })
            }
            _ => Ok(()),
        }
    }
}
