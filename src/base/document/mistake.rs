//! Kinds of mistakes and their words.

use super::phrases::{alternatives, and_more, and_nearest, bonding_distance, listed, proposal, short};

/// What is wrong: what was expected, and what was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Mistake {
    /// The text is not TOML.
    #[error("this is not TOML: {message}")]
    Syntax {
        /// The parser's words.
        message: String,
    },
    /// A file cannot be read.
    #[error("{file} cannot be read: {reason}")]
    Unreadable {
        /// The file, as the scene names it.
        file: String,
        /// Why.
        reason: String,
    },
    /// A key that has no meaning here.
    #[error("no such key; {}", proposal(.found, .known, "the keys here are"))]
    UnknownKey {
        /// The key.
        found: String,
        /// The keys that have one.
        known: Vec<String>,
    },
    /// A table that has no meaning.
    #[error("no such table; {}", proposal(.found, .known, "the tables are"))]
    UnknownTable {
        /// The table.
        found: String,
        /// The tables that have one.
        known: Vec<String>,
    },
    /// A sub-model that is not among those of its kind.
    #[error("no such {kind} model; {}", proposal(.found, .known, "there are"))]
    UnknownModel {
        /// The model.
        found: String,
        /// Normal, tangential, rolling or cohesion.
        kind: &'static str,
        /// Those that exist.
        known: Vec<String>,
    },
    /// A name that the scene does not define.
    #[error("expected a {kind} of this scene, found {found:?}; {}", proposal(.found, .known, "it has"))]
    UnknownName {
        /// The name.
        found: String,
        /// Of what.
        kind: &'static str,
        /// The names that the scene defines.
        known: Vec<String>,
    },
    /// A choice that is not offered.
    #[error("expected {}, found {found:?}{}", alternatives(.known), and_nearest(.found, .known))]
    Choice {
        /// What was chosen.
        found: String,
        /// What is offered.
        known: Vec<String>,
    },
    /// Something the program does not have.
    #[error("expected {instead}, found {what}, which this program does not have")]
    Unsupported {
        /// What, in the plural.
        what: &'static str,
        /// What is there.
        instead: &'static str,
    },
    /// A name with characters that names may not have.
    #[error("expected a name (a letter or _ followed by letters, digits or _), found {found:?}")]
    Name {
        /// The name.
        found: String,
    },
    /// Something needed is absent.
    #[error("missing; {expected}")]
    Missing {
        /// What belongs there, or who needs it.
        expected: String,
    },
    /// A value that is not permitted.
    #[error("expected {expected}, found {found}")]
    Unexpected {
        /// The value.
        found: String,
        /// What is permitted.
        expected: String,
    },
    /// A combination that makes no sense.
    #[error("{what}; {expected}")]
    InvalidCombination {
        /// The combination and why it is senseless.
        what: String,
        /// What would make sense.
        expected: String,
    },
    /// A value that a type refused in words of its own.
    #[error("{message}")]
    Refused {
        /// Those words.
        message: String,
    },
    /// The two tables of a pair of materials differ.
    #[error("expected one value of a pair of materials, found {found} here and {other} in [{table}]")]
    Asymmetric {
        /// The value here.
        found: String,
        /// The value there.
        other: String,
        /// The other table.
        table: String,
    },
    /// Two laws for one pair of materials.
    #[error("expected at most one law for {a} and {b}, found [contact.{other}], too")]
    TwoLaws {
        /// A material.
        a: String,
        /// The other.
        b: String,
        /// The law that came first.
        other: String,
    },
    /// No law for two materials that can touch.
    #[error("expected a [contact] table whose between names {a} and {b}, which can touch, found none")]
    NoLaw {
        /// A material.
        a: String,
        /// The other.
        b: String,
    },
    /// Columns that a data file does not have.
    #[error("expected a column {column}, found {}", listed(.found))]
    Column {
        /// The column.
        column: String,
        /// The columns it has.
        found: Vec<String>,
    },
    /// A file whose units are not known.
    #[error("expected units = \"si\", \"cgs\", \"micro\" or \"nano\" in the scene, found none, and none in the file")]
    NoUnits,
    /// A file in units that have no size, or that the program does not convert.
    #[error("expected si, cgs, micro or nano units, found {found} units")]
    Units {
        /// What the file says.
        found: String,
    },
    /// A number used twice.
    #[error(
        "expected a number of its own for each particle, found {id}, the number of another one of [particles.{other}]"
    )]
    DuplicateId {
        /// The number.
        id: u32,
        /// The set of the other particle.
        other: String,
    },
    /// A bond law without bonds.
    #[error("expected {}, found {}", bonding_distance(*.closest), short(*.distance))]
    BondsNoPair {
        /// Centres nearer than this are bonded \[m\].
        distance: f64,
        /// Least distance of two centres that may be bonded \[m\].
        closest: Option<f64>,
    },
    /// A group that holds nothing.
    #[error("chooses no particle; {expected}")]
    EmptySelection {
        /// What is there to choose.
        expected: String,
    },
    /// A particle that already belongs elsewhere.
    #[error("expected particles that no other one has, found particle {id} of {other}")]
    AlreadyTaken {
        /// The particle.
        id: u32,
        /// Where.
        other: String,
    },
    /// Two particles inside one another.
    #[error(
        "expected overlaps of at most {permitted} of the smaller radius ([run] max_overlap), found {overlap:.3} \
         between particles {a} and {b}{}{}", if *.across { " through a face of the cell" } else { "" }, and_more(*.more, "pair")
    )]
    Overlap {
        /// A particle.
        a: u32,
        /// The other.
        b: u32,
        /// Overlap over the smaller radius.
        overlap: f64,
        /// What is permitted of it.
        permitted: f64,
        /// Whether one is an image of itself in a periodic cell.
        across: bool,
        /// How many further pairs overlap as badly.
        more: usize,
    },
    /// A particle inside a plane.
    #[error(
        "expected overlaps of at most {permitted} of the radius ([run] max_overlap), found {overlap:.3} between \
         particle {id} and [boundary.{boundary}]{}", and_more(*.more, "particle")
    )]
    WallOverlap {
        /// The particle.
        id: u32,
        /// The plane.
        boundary: String,
        /// Overlap over the radius.
        overlap: f64,
        /// What is permitted of it.
        permitted: f64,
        /// How many further particles do.
        more: usize,
    },
    /// A particle whose centre is behind a plane, or behind the front of a closed mesh.
    #[error(
        "the centre of particle {id} is {depth:.3e} m behind [boundary.{boundary}]{}; \
         its normals point towards the particles", and_more(*.more, "particle")
    )]
    BehindSurface {
        /// The particle.
        id: u32,
        /// The plane.
        boundary: String,
        /// How far \[m\].
        depth: f64,
        /// How many further particles are.
        more: usize,
    },
    /// A particle outside the domain.
    #[error(
        "expected a box that holds every centre, found particle {id} outside at {position:?} m{}",
        and_more(*.more, "particle")
    )]
    OutsideDomain {
        /// The particle.
        id: u32,
        /// Where it is \[m\].
        position: [f64; 3],
        /// How many further particles are.
        more: usize,
    },
    /// A packing that does not fit its region.
    #[error(
        "expected room for {count} particles, found room for {reached} ({fraction:.3} of the region is filled); \
         take fewer or smaller ones, a larger region, or solid_fraction instead of count"
    )]
    RegionFull {
        /// How many found room.
        reached: usize,
        /// How many were asked for.
        count: usize,
        /// Volume of those over that of the region.
        fraction: f64,
    },
}
