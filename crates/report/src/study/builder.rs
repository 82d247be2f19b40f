//! Collects the blocks of the report, and numbers its figures and tables.

use minijinja::Value;

use super::document::{Block, Cell, Column, Figure, Group, Section, Table};
use crate::figure::{Chart, Drawing};
use crate::picture::file_stem;
use crate::words::Language;

/// A figure for files, where its title stands in the picture.
pub(super) struct FigureFile {
    pub(super) number: usize,
    pub(super) name: String,
    pub(super) drawing: Drawing,
}

/// The report while it is put together.
pub(super) struct Builder {
    pub(super) language: Language,
    pub(super) sections: Vec<Section>,
    pub(super) files: Vec<FigureFile>,
    tables: usize,
    keeps_files: bool,
}

/// A figure that is to be added.
pub(super) struct NewFigure<'a> {
    /// For its file.
    pub(super) name: &'a str,
    pub(super) title: &'a str,
    pub(super) caption: &'a str,
}

/// Width of a figure in the page [pixels].
pub(super) const WIDTH: f64 = 780.0;

impl Builder {
    /// An empty report; with `keeps_files` the figures are kept for files too.
    pub(super) fn new(language: Language, keeps_files: bool) -> Self {
        Builder {
            language,
            sections: Vec::new(),
            files: Vec::new(),
            tables: 0,
            keeps_files,
        }
    }

    /// Text of a message.
    pub(super) fn text(&self, key: &'static str) -> String {
        self.language.text(key).to_owned()
    }

    /// Text of a message with values.
    pub(super) fn fill(&self, key: &str, values: &[(&str, &str)]) -> String {
        self.language.fill(key, values)
    }

    /// Begins a section. One that stays empty is left out in the end.
    pub(super) fn section(&mut self, id: &'static str, title: String) {
        self.drop_empty();
        self.sections.push(Section {
            id,
            number: self.sections.len() + 1,
            title,
            blocks: Vec::new(),
        });
    }

    /// Leaves the last section out where nothing is in it.
    pub(super) fn drop_empty(&mut self) {
        let is_empty = |section: &Section| {
            let heading = |block: &Block| matches!(block, Block::Heading { .. });
            section.blocks.iter().all(heading)
        };
        self.sections.pop_if(|section| is_empty(section));
    }

    pub(super) fn block(&mut self, block: Block) {
        if let Some(section) = self.sections.last_mut() {
            section.blocks.push(block);
        }
    }

    pub(super) fn paragraph(&mut self, text: String) {
        self.block(Block::Text { text });
    }

    pub(super) fn notice(&mut self, text: String) {
        self.block(Block::Notice { text });
    }

    pub(super) fn table(
        &mut self,
        title: String,
        caption: String,
        columns: Vec<Column>,
        groups: Vec<Group>,
    ) {
        if groups.iter().all(|group| group.rows.is_empty()) {
            return;
        }
        self.tables += 1;
        self.block(Block::Table(Table {
            id: format!("table-{}", self.tables),
            number: self.tables,
            title,
            caption,
            columns,
            groups,
        }));
    }

    /// Adds a chart; in the page its title stands in the caption only.
    pub(super) fn chart(&mut self, figure: &NewFigure<'_>, mut chart: Chart) {
        chart.title.clear();
        chart.width = WIDTH;
        let page = chart.draw();
        let file = self.keeps_files.then(|| {
            figure.title.clone_into(&mut chart.title);
            chart.draw()
        });
        self.drawing(figure, page, file);
    }

    /// Adds a drawing: as it is in the page, and as it is in a file.
    pub(super) fn drawing(
        &mut self,
        figure: &NewFigure<'_>,
        mut page: Drawing,
        file: Option<Drawing>,
    ) {
        let number = 1 + self
            .sections
            .iter()
            .flat_map(|section| &section.blocks)
            .filter(|block| matches!(block, Block::Figure(_)))
            .count();
        let name = format!("{number:02}-{}", file_stem(figure.name));
        // What a screen reader says of the picture.
        figure.title.clone_into(&mut page.title);
        let svg = page.to_svg();
        if let Some(mut drawing) = file.filter(|_| self.keeps_files) {
            figure.title.clone_into(&mut drawing.title);
            self.files.push(FigureFile {
                number,
                name: name.clone(),
                drawing,
            });
        }
        self.block(Block::Figure(Figure {
            id: format!("figure-{number}"),
            number,
            name,
            title: figure.title.to_owned(),
            caption: figure.caption.to_owned(),
            svg: Value::from_safe_string(svg),
        }));
    }
}

/// A row of cells.
pub(super) fn row<const N: usize>(cells: [Cell; N]) -> Vec<Cell> {
    cells.into()
}
