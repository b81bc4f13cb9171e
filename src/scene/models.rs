//! The sub-models, rules of breakage, shapes and laws of fluids that scenes may name.

use crate::laws::bond::breakage::{self, Breakage, BreakageRow};
use crate::laws::column::{Column, TEMPERATURE};
use crate::laws::contact::{
    self, Cohesion, CohesionModel, CohesionRow, Heat, HeatModel, HeatRow, ModelKeys, ModelRow, Normal, NormalModel,
    NormalRow, Property, Rolling, RollingModel, RollingRow, Tangential, TangentialModel, TangentialRow, property,
};
use crate::laws::convection::{self, Convection, ConvectionRow};
use crate::laws::drag::{self, Drag, DragRow};
use crate::laws::lift::{self, Lift, LiftRow};
use crate::laws::surface::{self, ShapeKeys, ShapeRow};
use crate::laws::wear::{self, Wear, WearRow};

/// The sub-models, rules of breakage, shapes and laws of fluids that scenes may name: those of the program, and those that another crate adds.
///
/// ```
/// use cograin::contact::normal::hertz::Hertz;
/// use cograin::scene::Models;
///
/// // Any type that implements `cograin::contact::Normal` is added like this.
/// let models = Models::standard().with_normal::<Hertz>();
/// assert!(models.normal_names().contains(&"hertz"));
/// ```
#[derive(Clone, Debug)]
pub struct Models {
    /// Normal sub-models.
    pub(crate) normal: Vec<&'static NormalRow>,
    /// Tangential sub-models.
    pub(crate) tangential: Vec<&'static TangentialRow>,
    /// Rolling sub-models.
    pub(crate) rolling: Vec<&'static RollingRow>,
    /// Cohesion sub-models.
    pub(crate) cohesion: Vec<&'static CohesionRow>,
    /// Heat sub-models.
    pub(crate) heat: Vec<&'static HeatRow>,
    /// Rules of breakage.
    pub(crate) breakage: Vec<&'static BreakageRow>,
    /// Shapes of boundaries.
    pub(crate) shapes: Vec<&'static ShapeRow>,
    /// Drag laws of fluids.
    pub(crate) drag: Vec<&'static DragRow>,
    /// Laws of lift of fluids.
    pub(crate) lift: Vec<&'static LiftRow>,
    /// Laws of convection of fluids.
    pub(crate) convection: Vec<&'static ConvectionRow>,
    /// Models of wear.
    pub(crate) wear: Vec<&'static WearRow>,
    /// Columns of particles that scenes may ask for.
    pub(crate) columns: Vec<&'static Column>,
}

impl Default for Models {
    fn default() -> Self {
        Self::standard()
    }
}

impl Models {
    /// Those of the program.
    pub fn standard() -> Self {
        Self {
            normal: contact::normal::STANDARD.to_vec(),
            tangential: contact::tangential::STANDARD.to_vec(),
            rolling: contact::rolling::STANDARD.to_vec(),
            cohesion: contact::cohesion::STANDARD.to_vec(),
            heat: contact::heat::STANDARD.to_vec(),
            breakage: breakage::STANDARD.to_vec(),
            shapes: surface::STANDARD.to_vec(),
            drag: drag::STANDARD.to_vec(),
            lift: lift::STANDARD.to_vec(),
            convection: convection::STANDARD.to_vec(),
            wear: wear::STANDARD.to_vec(),
            columns: vec![&TEMPERATURE],
        }
    }

    /// The same and a normal sub-model, in place of one of the same name.
    pub fn with_normal<M: Normal>(mut self) -> Self {
        put(&mut self.normal, NormalRow::of::<M>(), ModelRow::name);
        self
    }

    /// The same and a tangential sub-model, in place of one of the same name.
    pub fn with_tangential<M: Tangential>(mut self) -> Self {
        put(&mut self.tangential, TangentialRow::of::<M>(), ModelRow::name);
        self
    }

    /// The same and a rolling sub-model, in place of one of the same name.
    pub fn with_rolling<M: Rolling>(mut self) -> Self {
        put(&mut self.rolling, RollingRow::of::<M>(), ModelRow::name);
        self
    }

    /// The same and a cohesion sub-model, in place of one of the same name.
    pub fn with_cohesion<M: Cohesion>(mut self) -> Self {
        put(&mut self.cohesion, CohesionRow::of::<M>(), ModelRow::name);
        self
    }

    /// The same and a heat sub-model, in place of one of the same name.
    pub fn with_heat<M: Heat>(mut self) -> Self {
        put(&mut self.heat, HeatRow::of::<M>(), ModelRow::name);
        self
    }

    /// The same and a rule of breakage, behind the others, in place of one of the same name.
    pub fn with_breakage<B: Breakage>(mut self) -> Self {
        put(&mut self.breakage, BreakageRow::of::<B>(), BreakageRow::name);
        self
    }

    /// The same and a shape of boundaries, in place of one of the same key.
    pub fn with_shape<K: ShapeKeys>(mut self) -> Self {
        put(&mut self.shapes, ShapeRow::of::<K>(), |row| row.key);
        self
    }

    /// The same and a drag law, in place of one of the same name.
    pub fn with_drag<D: Drag>(mut self) -> Self {
        put(&mut self.drag, DragRow::of::<D>(), DragRow::name);
        self
    }

    /// The same and a law of lift, in place of one of the same name.
    pub fn with_lift<L: Lift>(mut self) -> Self {
        put(&mut self.lift, LiftRow::of::<L>(), LiftRow::name);
        self
    }

    /// The same and a law of convection, in place of one of the same name.
    pub fn with_convection<C: Convection>(mut self) -> Self {
        put(&mut self.convection, ConvectionRow::of::<C>(), ConvectionRow::name);
        self
    }

    /// The same and a model of wear, in place of one of the same name.
    pub fn with_wear<W: Wear>(mut self) -> Self {
        put(&mut self.wear, WearRow::of::<W>(), WearRow::name);
        self
    }

    /// The same and a column of particles, in place of one of the same name.
    pub fn with_column(mut self, column: &'static Column) -> Self {
        put(&mut self.columns, column, |column| column.name);
        self
    }

    /// Keys of `[pair.<a>.<b>]`: those of the program, and those that sub-models declare.
    pub(crate) fn pair_properties(&self) -> Vec<&'static Property> {
        let mut all = property::STANDARD.to_vec();
        self.declared(0).for_each(|declared| put(&mut all, declared, |property| property.name));
        all
    }

    /// Keys of `[material.<name>]` that sub-models declare.
    pub(crate) fn material_properties(&self) -> Vec<&'static Property> {
        let mut all = Vec::new();
        self.declared(1).for_each(|declared| put(&mut all, declared, |property| property.name));
        all
    }

    /// Properties that sub-models declare, of pairs (0) or of materials (1).
    fn declared(&self, kind: usize) -> impl Iterator<Item = &'static Property> {
        let normal = self.normal.iter().map(|row| row.properties);
        let tangential = self.tangential.iter().map(|row| row.properties);
        let rolling = self.rolling.iter().map(|row| row.properties);
        let cohesion = self.cohesion.iter().map(|row| row.properties);
        let heat = self.heat.iter().map(|row| row.properties);
        let all = normal.chain(tangential).chain(rolling).chain(cohesion).chain(heat);
        all.flat_map(move |properties| properties[kind].iter().copied())
    }

    /// The normal sub-model of this name with these keys, if there is one and they are of its type.
    pub fn normal<K: ModelKeys>(&self, name: &str, keys: K) -> Option<NormalModel> {
        self.normal.iter().find(|row| row.name() == name)?.with(keys)
    }

    /// The tangential sub-model of this name with these keys, if there is one and they are of its type.
    pub fn tangential<K: ModelKeys>(&self, name: &str, keys: K) -> Option<TangentialModel> {
        self.tangential.iter().find(|row| row.name() == name)?.with(keys)
    }

    /// The rolling sub-model of this name with these keys, if there is one and they are of its type.
    pub fn rolling<K: ModelKeys>(&self, name: &str, keys: K) -> Option<RollingModel> {
        self.rolling.iter().find(|row| row.name() == name)?.with(keys)
    }

    /// The cohesion sub-model of this name with these keys, if there is one and they are of its type.
    pub fn cohesion<K: ModelKeys>(&self, name: &str, keys: K) -> Option<CohesionModel> {
        self.cohesion.iter().find(|row| row.name() == name)?.with(keys)
    }

    /// The heat sub-model of this name with these keys, if there is one and they are of its type.
    pub fn heat<K: ModelKeys>(&self, name: &str, keys: K) -> Option<HeatModel> {
        self.heat.iter().find(|row| row.name() == name)?.with(keys)
    }

    /// Names of the normal sub-models.
    pub fn normal_names(&self) -> Vec<&'static str> {
        names(&self.normal)
    }

    /// Names of the tangential sub-models.
    pub fn tangential_names(&self) -> Vec<&'static str> {
        names(&self.tangential)
    }

    /// Names of the rolling sub-models.
    pub fn rolling_names(&self) -> Vec<&'static str> {
        names(&self.rolling)
    }

    /// Names of the cohesion sub-models.
    pub fn cohesion_names(&self) -> Vec<&'static str> {
        names(&self.cohesion)
    }
}

/// Adds a row to others, in place of that of the same name.
fn put<R>(rows: &mut Vec<&'static R>, row: &'static R, name: impl Fn(&R) -> &'static str) {
    rows.retain(|other| name(other) != name(row));
    rows.push(row);
}

/// The names of sub-models.
fn names<F>(rows: &[&'static ModelRow<F>]) -> Vec<&'static str> {
    rows.iter().map(|row| row.name()).collect()
}

/// No friction.
pub(crate) const SMOOTH: TangentialModel =
    TangentialModel::fixed::<contact::tangential::none::None>(&contact::NoKeys {});

/// No resistance against rolling.
pub(crate) const ROLLING_FREELY: RollingModel =
    RollingModel::fixed::<contact::rolling::none::None>(&contact::NoKeys {});

/// No attraction.
pub(crate) const DRY: CohesionModel = CohesionModel::fixed::<contact::cohesion::none::None>(&contact::NoKeys {});
