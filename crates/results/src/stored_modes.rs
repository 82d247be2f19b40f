//! Reads natural modes back from a store.

use serde_json::from_str;

use crate::layout::{self, MODES_KEY};
use crate::modes::{COMPONENTS, ModeShapes};
use crate::store_reader::text;
use crate::zarr::{Array, Group, Place};
use crate::{CaseModes, ModesReport, StoreError, StoredCase};

impl StoredCase {
    /// The natural modes of the case; `None` where none were computed.
    pub fn modes(&self) -> Result<Option<CaseModes>, StoreError> {
        let place = layout::modes_place(self.group().place());
        if !place.is_node() {
            return Ok(None);
        }
        let report = text(&Group::at(place.clone()).attributes()?, MODES_KEY);
        if report.is_empty() {
            // An earlier version did not store the table.
            return Ok(None);
        }
        let report: ModesReport =
            from_str(&report).map_err(|error| self.damaged(&error.to_string()))?;
        let shapes = |folder: &str| -> Result<Vec<ModeShapes>, StoreError> {
            let mut shapes = place
                .join(folder)
                .children()?
                .iter()
                .map(|place| self.shapes(place, report.modes.len()))
                .collect::<Result<Vec<_>, _>>()?;
            shapes.sort_by(|a, b| a.name.cmp(&b.name));
            Ok(shapes)
        };
        Ok(Some(CaseModes {
            lines: shapes("lines")?,
            bodies: shapes("bodies")?,
            report,
        }))
    }

    /// The shapes of one line or body.
    fn shapes(&self, place: &Place, modes: usize) -> Result<ModeShapes, StoreError> {
        let name = text(&Group::at(place.clone()).attributes()?, "name");
        let arc_length = place.join("arc_length");
        let arc_length = match arc_length.is_node() {
            true => Some(Array::open(arc_length)?.read()?),
            false => None,
        };
        let nodes = arc_length.as_ref().map_or(1, Vec::len);
        let mut motion = vec![vec![[0.0; 6]; nodes]; modes];
        for (component, (array, _, _)) in COMPONENTS.into_iter().enumerate() {
            let values = Array::open(place.join(array))?.read()?;
            if values.len() != modes * nodes {
                return Err(self.damaged("the shapes of its modes do not fit their number"));
            }
            let places = motion.iter_mut().flatten();
            for (place, value) in places.zip(values) {
                place[component] = value;
            }
        }
        Ok(ModeShapes {
            name,
            arc_length,
            motion,
        })
    }
}
