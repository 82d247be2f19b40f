//! What the report reads from the store, once.

use catenix_results::{
    CaseSummary, History, Scene, Setting, Status, StoreError, StoredCase, StoredStudy, Summary,
};

/// Position of each node (n_nodes x 3) [m], and the time [s].
pub(super) type Positions = (f64, Vec<[f64; 3]>);

/// A study out of its store.
pub(super) struct StudyData<'a> {
    pub(super) study: &'a StoredStudy,
    pub(super) summary: Summary,
    pub(super) cases: Vec<CaseData>,
}

/// A load case out of the store.
pub(super) struct CaseData {
    pub(super) name: String,
    pub(super) stored: StoredCase,
    pub(super) summary: CaseSummary,
    pub(super) scene: Option<Scene>,
    pub(super) settings: Vec<Setting>,
    /// Whether the static state was found.
    pub(super) has_results: bool,
    /// Channels of the store, sorted.
    pub(super) channels: Vec<String>,
}

impl<'a> StudyData<'a> {
    pub(super) fn read(study: &'a StoredStudy) -> Result<Self, StoreError> {
        let summary = study.summary()?;
        let case = |name: &String| -> Result<CaseData, StoreError> {
            let stored = study.case(name)?;
            let has_results = stored.has_results()?;
            Ok(CaseData {
                name: name.clone(),
                summary: match summary.cases.get(name) {
                    Some(summary) => summary.clone(),
                    None => stored.summary()?,
                },
                scene: stored.scene()?,
                settings: stored.settings()?,
                channels: match has_results {
                    true => stored.channel_names()?,
                    false => Vec::new(),
                },
                has_results,
                stored,
            })
        };
        let cases = study.case_names().iter().map(case);
        let cases = cases.collect::<Result<Vec<_>, _>>()?;
        Ok(StudyData {
            study,
            summary,
            cases,
        })
    }

    /// Cases that have got results.
    pub(super) fn computed(&self) -> Vec<&CaseData> {
        self.cases.iter().filter(|case| case.has_results).collect()
    }

    /// Whether no case has results, and none has failed: there is nothing to report.
    pub(super) fn is_empty(&self) -> bool {
        let says_nothing =
            |case: &CaseData| !case.has_results && case.summary.status != Status::Failed;
        self.cases.iter().all(says_nothing)
    }
}

impl CaseData {
    /// The name, with the description where there is one.
    pub(super) fn label(&self) -> String {
        match self.summary.description.as_str() {
            "" => self.name.clone(),
            description => format!("{}: {description}", self.name),
        }
    }

    pub(super) fn has_channel(&self, name: &str) -> bool {
        let found = self
            .channels
            .binary_search_by(|known| known.as_str().cmp(name));
        found.is_ok()
    }

    /// A history; `None` where the case does not have it.
    pub(super) fn history(&self, channel: &str) -> Result<Option<History>, StoreError> {
        if !self.has_channel(channel) {
            return Ok(None);
        }
        self.stored.channel(channel).map(Some)
    }

    /// A quantity along a line in the static state; `None` where the case does not have it.
    pub(super) fn static_state(
        &self,
        line: &str,
        quantity: &str,
    ) -> Result<Option<Vec<f64>>, StoreError> {
        let known = match self.stored.quantity(line, quantity) {
            Err(StoreError::UnknownLineResult { .. }) => return Ok(None),
            other => other?,
        };
        match self.stored.static_state(line, known) {
            Err(StoreError::UnknownLineResult { .. }) => Ok(None),
            other => other.map(Some),
        }
    }

    /// Static position of the nodes of a line (n_nodes x 3) [m].
    pub(super) fn static_positions(&self, line: &str) -> Result<Option<Vec<[f64; 3]>>, StoreError> {
        let [x, y, z] = ["x", "y", "z"].map(|axis| self.static_state(line, axis));
        Ok(joined(x?, y?, z?))
    }

    /// Last stored position of the nodes of a line (n_nodes x 3) [m], and its time [s].
    pub(super) fn last_positions(&self, line: &str) -> Result<Option<Positions>, StoreError> {
        let mut rows = Vec::new();
        for axis in ["x", "y", "z"] {
            let quantity = match self.stored.quantity(line, axis) {
                Err(StoreError::UnknownLineResult { .. }) => return Ok(None),
                other => other?,
            };
            rows.push(self.stored.last_row(line, quantity)?);
        }
        let mut rows = rows.into_iter();
        let (Some(Some((time, x))), Some(Some((_, y))), Some(Some((_, z)))) =
            (rows.next(), rows.next(), rows.next())
        else {
            return Ok(None);
        };
        Ok(joined(Some(x), Some(y), Some(z)).map(|positions| (time, positions)))
    }
}

fn joined(x: Option<Vec<f64>>, y: Option<Vec<f64>>, z: Option<Vec<f64>>) -> Option<Vec<[f64; 3]>> {
    let places = x?.into_iter().zip(y?).zip(z?);
    Some(places.map(|((x, y), z)| [x, y, z]).collect())
}
