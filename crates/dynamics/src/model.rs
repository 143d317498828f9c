//! Masses, springs, dampers, storeys: inert, checked data without an algorithm.

mod builder;
mod structure;
mod tank;

pub use builder::ModelBuilder;
pub use structure::{ACROSS, ROUNDED_ACROSS, ROUNDED_MASS, largest_mass_kg};
pub use structure::{ModeInPlane, OscillatorInPlane, Structure, StructureMode, StructurePoint};
pub use tank::LiquidTank;

use crate::error::ModelError;
use crate::slider::ranges::{finite, in_range, not_negative, optional_positive, positive};
use crate::slider::{Friction, Law};
use crate::units::STANDARD_GRAVITY_M_PER_S2;

pub use crate::linear::shear_frame_frequencies;
pub use crate::slider::{Slider, Stop, StopKind};

/// The rigid block that slides, `M1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Mass `M1` in kg.
    pub mass_kg: f64,
    /// Width along x in m; with storey heights the overturning ratio is reported.
    pub width_m: Option<f64>,
    /// Height in m, where the block's own inertia counts for overturning; a thin block has none.
    pub height_m: Option<f64>,
}

/// Damping of the storeys.
#[derive(Clone, Debug, PartialEq)]
pub enum Damping {
    /// One ratio of critical damping for every fixed-base mode:
    /// `C = M Φ diag(2 ξ ω) Φᵀ M` with mass-normalised modes Φ.
    Ratio(f64),
    /// Dampers between neighbouring floors in N s/m, from the block up.
    Dampers(Vec<f64>),
}

/// The linear structure on the block: a shear frame of any number of storeys, from the block up.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Mass of each floor in kg.
    pub masses_kg: Vec<f64>,
    /// Stiffness of each storey (between a floor and the one below it) in N/m.
    pub stiffnesses_n_per_m: Vec<f64>,
    /// Damping.
    pub damping: Damping,
    /// Height of each storey in m.
    pub heights_m: Option<Vec<f64>>,
}

impl Frame {
    /// No storeys: the rigid block alone (section 3 of the paper).
    #[must_use]
    pub fn none() -> Self {
        Self {
            masses_kg: Vec::new(),
            stiffnesses_n_per_m: Vec::new(),
            damping: Damping::Ratio(0.0),
            heights_m: None,
        }
    }
}

/// State at t = 0; storey values are relative to the block, one a storey.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialState {
    /// Sliding displacement `s` in m; the spring is unstressed at 0.
    pub sliding_displacement_m: f64,
    /// Sliding velocity `ṡ` in m/s.
    pub sliding_velocity_m_per_s: f64,
    /// Storey displacements `q` in m; `None`: static equilibrium on the slope.
    pub storey_displacement_m: Option<Vec<f64>>,
    /// Storey velocities `q̇` in m/s; `None`: at rest.
    pub storey_velocity_m_per_s: Option<Vec<f64>>,
}

impl InitialState {
    /// All at rest, the spring unstressed, friction carries the slope.
    #[must_use]
    pub fn rest() -> Self {
        Self {
            sliding_displacement_m: 0.0,
            sliding_velocity_m_per_s: 0.0,
            storey_displacement_m: None,
            storey_velocity_m_per_s: None,
        }
    }
}

/// What is along y where the table moves in two horizontal directions: the frame has the masses that it
/// has along x and does not twist, the slider is the same in all directions. A structure by its modes has its own
/// directions: of stiffnesses and damping it has none here, and the start of storeys is that of the
/// [oscillators](Structure::oscillators_in_plane) that its modes are, one value each.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongY {
    /// Stiffness of each storey in N/m.
    pub stiffnesses_n_per_m: Vec<f64>,
    /// Damping.
    pub damping: Damping,
    /// Width of the block in m; with storey heights the overturning ratio is reported.
    pub width_m: Option<f64>,
    /// State at t = 0.
    pub initial: InitialState,
}

/// Something that stands unfastened on the block or on a floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contents {
    /// 0 on the block, else the storey on whose floor it stands, from the block up.
    pub floor: usize,
    /// Mass in kg.
    pub mass_kg: f64,
    /// Static coefficient of friction.
    pub static_friction: f64,
    /// Kinetic coefficient of friction.
    pub kinetic_friction: f64,
}

impl Contents {
    fn check(&self, storeys: usize) -> Result<(), ModelError> {
        positive("contents mass_kg", self.mass_kg)?;
        finite("contents static_friction", self.static_friction)?;
        not_negative("contents kinetic_friction", self.kinetic_friction)?;
        in_range(
            "contents kinetic_friction",
            "at most the static friction",
            self.kinetic_friction,
            self.kinetic_friction <= self.static_friction,
        )?;
        in_range(
            "contents floor",
            "0 for the block, or the number of a storey",
            self.floor as f64,
            self.floor <= storeys,
        )
    }
}

/// A checked model: block, slider, structure, gravity and initial state.
///
/// [`Model::builder`] takes quantities with units, [`Model::new`] numbers in SI, and
/// `slipstick::input::parse` the text of a model file.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    block: Block,
    slider: Slider,
    frame: Frame,
    structure: Option<Structure>,
    gravity_m_per_s2: f64,
    initial: InitialState,
    along_y: Option<AlongY>,
    contents: Vec<Contents>,
}

impl Model {
    /// Checks every number; repairs none.
    ///
    /// # Errors
    /// [`ModelError`] names the first quantity that is not finite or out of range: masses and
    /// storey stiffnesses must be > 0, `K1`, `C1`, dampers and damping ratios ≥ 0, |θ| < π/2,
    /// gravity, gap, radius, width and heights > 0, one value a storey. A stop needs a gap on one side
    /// at least and a stiffness > 0; the start is between rigid stops, and within the travel of surfaces.
    pub fn new(
        block: Block,
        slider: Slider,
        frame: Frame,
        gravity_m_per_s2: f64,
        initial: InitialState,
    ) -> Result<Self, ModelError> {
        let n = frame.masses_kg.len();
        positive("block mass_kg", block.mass_kg)?;
        optional_positive("block width_m", block.width_m)?;
        optional_positive("block height_m", block.height_m)?;
        let start_m = initial.sliding_displacement_m;
        slider.check(start_m)?;
        positive("gravity_m_per_s2", gravity_m_per_s2)?;
        each("storey masses_kg", n, &frame.masses_kg, positive)?;
        each("storey stiffnesses_n_per_m", n, &frame.stiffnesses_n_per_m, positive)?;
        match &frame.damping {
            Damping::Ratio(ratio) => not_negative("storey damping_ratio", *ratio)?,
            Damping::Dampers(c) => each("storey dampers_n_s_per_m", n, c, not_negative)?,
        }
        if let Some(heights_m) = &frame.heights_m {
            each("storey heights_m", n, heights_m, positive)?;
        }
        check_start(&initial, n)?;
        slider.stop().map_or(Ok(()), |stop| stop.admits(start_m))?;
        let model = Self {
            block,
            slider,
            frame,
            structure: None,
            gravity_m_per_s2,
            initial,
            along_y: None,
            contents: Vec::new(),
        };
        model.with_contents(Vec::new())
    }

    /// A model whose structure is given by its modes, each an oscillator on the block; what they lack of the
    /// mass is added to the block's.
    ///
    /// # Errors
    /// [`ModelError`] as [`Model::new`]; a structure needs a mode that takes part, a value a point in each, and
    /// effective masses that sum to at most its mass.
    pub fn with_modes(
        block: Block,
        slider: Slider,
        structure: Structure,
        gravity_m_per_s2: f64,
        initial: InitialState,
    ) -> Result<Self, ModelError> {
        positive("block mass_kg", block.mass_kg)?;
        structure.check()?;
        let frame = structure.oscillators();
        let bare_kg = block.mass_kg;
        let block = Block { mass_kg: bare_kg + structure.missing_mass_kg(), ..block };
        let model = Self::new(block, slider, frame, gravity_m_per_s2, initial)?;
        // What moves with the block is a mass in every direction.
        let most = largest_mass_kg(structure.mass_in_plane_kg());
        let expected = "a block heavier than what rounding makes of the mass that modes lack";
        in_range("block mass_kg", expected, bare_kg, most < model.total_mass_kg())?;
        Ok(Self { structure: Some(structure), ..model })
    }

    /// The structure, where it is given by its modes; [`frame`](Self::frame) then has their oscillators, each
    /// on the block.
    #[must_use]
    pub fn structure(&self) -> Option<&Structure> {
        self.structure.as_ref()
    }

    /// Number of points whose motion is told: the floors of a frame, or the points of a structure by its modes.
    #[must_use]
    pub fn points(&self) -> usize {
        self.structure.as_ref().map_or(self.storeys(), |structure| structure.points.len())
    }

    /// Mass of the block in kg without what the modes of the structure lack.
    #[must_use]
    pub fn bare_block_kg(&self) -> f64 {
        let missing = self.structure.as_ref().map_or(0.0, Structure::missing_mass_kg);
        self.block.mass_kg - missing
    }

    /// Whether each point has a mass: the floors of a frame have, those of a structure by its modes where they are given one.
    #[must_use]
    pub fn has_point_masses(&self) -> bool {
        let of_point = |structure: &Structure| structure.points.iter().all(|p| p.mass_kg.is_some());
        self.structure.as_ref().is_none_or(of_point)
    }

    /// Mass of each point in kg, where each has one.
    #[must_use]
    pub fn point_masses_kg(&self) -> Option<Vec<f64>> {
        match &self.structure {
            Some(structure) => structure.points.iter().map(|point| point.mass_kg).collect(),
            None => Some(self.frame.masses_kg.clone()),
        }
    }

    /// Mass of each point and its height above the sliding surface, in kg and m, where block and points have
    /// what an overturning moment is made of.
    #[must_use]
    pub fn lever_arms(&self) -> Option<Vec<[f64; 2]>> {
        let block_m = self.block.height_m.unwrap_or(0.0);
        if let Some(structure) = &self.structure {
            let raised = |[mass_kg, height_m]: [f64; 2]| [mass_kg, block_m + height_m];
            return Some(structure.shares()?.into_iter().map(raised).collect());
        }
        let heights_m = match &self.frame.heights_m {
            Some(heights_m) => heights_m.as_slice(),
            None if self.storeys() == 0 && self.block.height_m.is_some() => &[],
            None => return None,
        };
        let mut above_m = block_m;
        let floors = self.frame.masses_kg.iter().zip(heights_m).map(|(mass_kg, height_m)| {
            above_m += height_m;
            [*mass_kg, above_m]
        });
        Some(floors.collect())
    }

    /// One over the overturning moment along x and y that the weight resists about an edge, `M_tot g width/2`, in
    /// 1/(N m), where both widths are given and heights are.
    pub(crate) fn per_resisted_moment_in_plane(&self) -> Option<[f64; 2]> {
        self.lever_arms()?;
        let widths_m = [self.block.width_m?, self.along_y.as_ref()?.width_m?];
        Some(widths_m.map(|width_m| 1.0 / (0.5 * width_m * self.weight_n())))
    }

    /// Height of a floor above the one below or of a point above the one before it, in m, where it is known.
    #[must_use]
    pub fn rise_m(&self, point: usize) -> Option<f64> {
        match &self.structure {
            Some(structure) => structure.rise_m(point),
            None => self.frame.heights_m.as_ref().map(|heights_m| heights_m[point]),
        }
    }

    /// This model with another structure or start along y; without it y is as x, and starts at rest.
    ///
    /// # Errors
    /// [`ModelError`] as [`Model::new`].
    pub fn with_along_y(mut self, along_y: AlongY) -> Result<Self, ModelError> {
        let [n, started] = match &self.structure {
            Some(structure) => [0, structure.oscillators_in_plane().len()],
            None => [self.storeys(); 2],
        };
        optional_positive("block width_y_m", along_y.width_m)?;
        each("storey stiffnesses_y_n_per_m", n, &along_y.stiffnesses_n_per_m, positive)?;
        match &along_y.damping {
            Damping::Ratio(ratio) => not_negative("storey damping_ratio_y", *ratio)?,
            Damping::Dampers(c) => each("storey dampers_y_n_s_per_m", n, c, not_negative)?,
        }
        check_start(&along_y.initial, started)?;
        if let Some(stop) = self.slider.stop() {
            let start = [&self.initial, &along_y.initial];
            let [x, y] = start.map(|initial| initial.sliding_displacement_m);
            if y != 0.0 {
                stop.admits(libm::hypot(x, y))?;
            }
        }
        self.along_y = Some(along_y);
        Ok(self)
    }

    /// What is along y: as given, or as along x and at rest.
    #[must_use]
    pub fn along_y(&self) -> AlongY {
        self.along_y.clone().unwrap_or_else(|| {
            let (stiffnesses_n_per_m, damping) = match &self.structure {
                Some(_) => (Vec::new(), Damping::Ratio(0.0)),
                None => (self.frame.stiffnesses_n_per_m.clone(), self.frame.damping.clone()),
            };
            let initial = InitialState::rest();
            AlongY { stiffnesses_n_per_m, damping, width_m: None, initial }
        })
    }

    /// Whether it says what is along y.
    pub fn is_in_plane(&self) -> bool {
        self.along_y.is_some()
    }

    /// Coordinates of the structure in two directions: those of floors along x and along y, or one a mode.
    #[must_use]
    pub fn degrees_in_plane(&self) -> usize {
        match &self.structure {
            Some(structure) => structure.oscillators_in_plane().len(),
            None => 2 * self.storeys(),
        }
    }

    /// Storeys of a [history](crate::response::History) in two directions: floors, or modes.
    #[must_use]
    pub fn storeys_in_plane(&self) -> usize {
        match &self.structure {
            Some(_) => self.degrees_in_plane(),
            None => self.storeys(),
        }
    }

    /// This model turned so that what is along a direction is along x, if it moves along that alone when it is pushed
    /// so: along an axis, or of a structure that is the same along both. The width is that of an axis.
    pub(crate) fn turned_to(&self, [x, y]: [f64; 2]) -> Option<Self> {
        let turned = self.turned_to_y();
        let (model, other) = if x == 0.0 { (&turned, self) } else { (self, &turned) };
        let width_m = model.block.width_m.or(other.block.width_m);
        let is_axis = x == 0.0 || y == 0.0;
        let both = |of: &dyn Fn(&Self) -> f64| match is_axis {
            true => of(model),
            false => x * of(model) + y * of(other),
        };
        let lists = |of: &dyn Fn(&Self) -> Vec<f64>| -> Option<Vec<f64>> {
            let own = of(model).into_iter().enumerate();
            Some(own.map(|(i, _)| both(&|model| of(model)[i])).collect())
        };
        let initial = InitialState {
            sliding_displacement_m: both(&|model| model.initial.sliding_displacement_m),
            sliding_velocity_m_per_s: both(&|model| model.initial.sliding_velocity_m_per_s),
            storey_displacement_m: lists(&Self::initial_storey_displacement_m),
            storey_velocity_m_per_s: lists(&Self::initial_storey_velocity_m_per_s),
        };
        let block = Block { width_m, ..model.block };
        if let Some(structure) = &self.structure {
            let own = self.along_y().initial;
            let start = [own.storey_displacement_m, own.storey_velocity_m_per_s];
            if start.iter().flatten().flatten().any(|value| *value != 0.0) {
                return None;
            }
            let block = Block { mass_kg: self.bare_block_kg(), ..block };
            let initial = InitialState {
                storey_displacement_m: None,
                storey_velocity_m_per_s: None,
                ..initial
            };
            let structure = structure.along([x, y])?;
            let slider = self.slider.turned_to([x, y]);
            return Self::with_modes(block, slider, structure, self.gravity_m_per_s2, initial).ok();
        }
        let is_same = model.frame.stiffnesses_n_per_m == other.frame.stiffnesses_n_per_m
            && (model.frame.damping == other.frame.damping || self.storeys() == 0);
        let (frame, slider) = (model.frame.clone(), self.slider.turned_to([x, y]));
        (is_axis || is_same).then(|| Self {
            block,
            slider,
            frame,
            initial,
            along_y: None,
            ..self.clone()
        })
    }

    /// A rigid block of all its mass on [one surface](Slider::as_one_surface) that does what its slider does, of a model with
    /// surfaces in series or contents, which two directions do not take; none of other models.
    #[must_use]
    pub fn simple_in_plane(&self) -> Option<Self> {
        if self.slider.series().is_none() && self.contents.is_empty() {
            return None;
        }
        let block = Block { mass_kg: self.total_mass_kg(), width_m: None, height_m: None };
        let (slider, start) = (self.slider.as_one_surface()?, InitialState::rest());
        Self::new(block, slider, Frame::none(), self.gravity_m_per_s2, start).ok()
    }

    /// This model turned so that what is along y is along x.
    pub fn turned_to_y(&self) -> Self {
        let AlongY { stiffnesses_n_per_m, damping, width_m, initial } = self.along_y();
        let block = Block { width_m, ..self.block };
        let Slider { tilt_rad, tilt_y_rad, .. } = self.slider;
        let slider = Slider { tilt_rad: tilt_y_rad, tilt_y_rad: tilt_rad, ..self.slider.clone() };
        if self.structure.is_some() {
            return Self { block, slider, initial, along_y: None, ..self.clone() };
        }
        Self {
            block,
            slider,
            frame: Frame { stiffnesses_n_per_m, damping, ..self.frame.clone() },
            initial,
            along_y: None,
            ..self.clone()
        }
    }

    /// This model with contents, in the place of those that it had.
    ///
    /// # Errors
    /// [`ModelError`] for contents without mass, with more kinetic than static friction, or on a floor
    /// that is not there.
    pub fn with_contents(mut self, contents: Vec<Contents>) -> Result<Self, ModelError> {
        // The oscillators of modes are no floors.
        let floors = if self.structure.is_some() { 0 } else { self.storeys() };
        contents.iter().try_for_each(|contents| contents.check(floors))?;
        self.contents = contents;
        // That of a pendulum may have grown beyond all numbers.
        not_negative("slider stiffness_n_per_m", self.slider_stiffness_n_per_m())?;
        Ok(self)
    }

    /// What slides on the floors, in the order of the file.
    #[must_use]
    pub fn contents(&self) -> &[Contents] {
        &self.contents
    }

    /// The rigid block alone on a level surface at rest, under standard gravity.
    ///
    /// # Errors
    /// As [`Model::new`].
    ///
    /// # Examples
    /// ```
    /// use slipstick_dynamics::slider::Friction;
    /// use slipstick_dynamics::model::Model;
    ///
    /// let model = Model::rigid_block(124.0, Friction::new(0.2, 0.15)?)?;
    /// assert_eq!(model.weight_n(), 124.0 * 9.80665);
    /// # Ok::<(), slipstick_dynamics::error::ModelError>(())
    /// ```
    pub fn rigid_block(mass_kg: f64, friction: Friction) -> Result<Self, ModelError> {
        Self::new(
            Block { mass_kg, width_m: None, height_m: None },
            Slider::new(friction),
            Frame::none(),
            STANDARD_GRAVITY_M_PER_S2,
            InitialState::rest(),
        )
    }

    /// The block.
    #[must_use]
    pub fn block(&self) -> &Block {
        &self.block
    }

    /// The bearing.
    #[must_use]
    pub fn slider(&self) -> &Slider {
        &self.slider
    }

    /// The stop at the end of the slider's travel.
    #[must_use]
    pub fn stop(&self) -> Option<&Stop> {
        self.slider.stop()
    }

    /// The structure on the block.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Number of storeys `n`.
    #[must_use]
    pub fn storeys(&self) -> usize {
        self.frame.masses_kg.len()
    }

    /// Acceleration of gravity `g` in m/s².
    #[must_use]
    pub fn gravity_m_per_s2(&self) -> f64 {
        self.gravity_m_per_s2
    }

    /// The state at t = 0.
    #[must_use]
    pub fn initial(&self) -> &InitialState {
        &self.initial
    }

    /// `M_tot = M1 + Σ m_i` in kg, with the contents.
    #[must_use]
    pub fn total_mass_kg(&self) -> f64 {
        let frame = self.frame.masses_kg.iter().fold(self.block.mass_kg, |sum, m| sum + m);
        self.contents.iter().fold(frame, |sum, contents| sum + contents.mass_kg)
    }

    /// `M_tot g` in N.
    #[must_use]
    pub fn weight_n(&self) -> f64 {
        self.total_mass_kg() * self.gravity_m_per_s2
    }

    /// `g sin θ` in m/s²: the slope's pull towards −x as an acceleration of the table.
    #[must_use]
    pub fn slope_m_per_s2(&self) -> f64 {
        self.gravity_m_per_s2 * libm::sin(self.slider.tilt_rad)
    }

    /// The slope's pull along x and y, towards −x and −y, as accelerations of the table in m/s².
    #[must_use]
    pub fn slope_in_plane_m_per_s2(&self) -> [f64; 2] {
        self.slider.slope_sines().map(|sine| self.gravity_m_per_s2 * sine)
    }

    /// `g cos θ` in m/s²: what presses the block on the surface at rest.
    #[must_use]
    pub fn normal_gravity_m_per_s2(&self) -> f64 {
        self.gravity_m_per_s2 * self.slider.slope_cosine()
    }

    /// What presses the block on the surface without vertical motion, in N.
    #[must_use]
    pub fn normal_n(&self) -> f64 {
        self.total_mass_kg() * self.normal_gravity_m_per_s2()
    }

    /// Stiffness in N/m of the slider's spring, of a pendulum that under the weight: `M_tot g cos θ/R`.
    #[must_use]
    pub fn slider_stiffness_n_per_m(&self) -> f64 {
        self.slider.stiffness_n_per_m(self.normal_n())
    }

    /// This model with other friction; surfaces in series keep theirs.
    #[must_use]
    pub fn with_friction(&self, friction: Friction) -> Self {
        let model = self.clone();
        Self { slider: model.slider.with_friction(friction), ..model }
    }

    /// This model with all coefficients of the slider times `factor`.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] unless the factor is finite and ≥ 0.
    pub fn with_friction_times(&self, factor: f64) -> Result<Self, ModelError> {
        Ok(Self { slider: self.slider.with_friction_times(factor)?, ..self.clone() })
    }

    /// Whether another model has the same linear system, start and contents: whether the two differ in the
    /// slider's constant coefficients of friction and its gap alone.
    #[must_use]
    pub fn has_system_of(&self, other: &Self) -> bool {
        self.slider.has_system_of(&other.slider)
            && self.gravity_m_per_s2 == other.gravity_m_per_s2
            && self.block == other.block
            && self.frame == other.frame
            && self.structure == other.structure
            && self.initial == other.initial
            && self.along_y == other.along_y
            && self.contents == other.contents
    }

    /// The law of the slider, under a normal force that is constant or varies.
    pub(crate) fn law(&self, varying: bool) -> Law<'_> {
        self.slider.law(self.normal_n(), varying)
    }

    /// Static friction coefficients for sliding towards +x and −x; of surfaces in series those of the
    /// first to slide.
    #[must_use]
    pub fn static_friction(&self) -> [f64; 2] {
        self.slider.coefficients()[0]
    }

    /// Kinetic friction coefficients while sliding towards +x and −x, at rest where they follow the
    /// speed; of surfaces in series those of the first to slide.
    #[must_use]
    pub fn kinetic_friction(&self) -> [f64; 2] {
        self.slider.coefficients()[1]
    }

    /// Storey displacements at t = 0 in m: as given, else `−K⁻¹ M 1 g sin θ`.
    #[must_use]
    pub fn initial_storey_displacement_m(&self) -> Vec<f64> {
        if let Some(q) = &self.initial.storey_displacement_m {
            return q.clone();
        }
        let slope = self.slope_m_per_s2();
        let (m, k) = (&self.frame.masses_kg, &self.frame.stiffnesses_n_per_m);
        let mut q = vec![0.0; m.len()];
        let mut below_m = 0.0;
        for i in 0..m.len() {
            if self.structure.is_some() {
                q[i] = -slope * m[i] / k[i];
                continue;
            }
            // Storey i carries the slope's pull on all floors from i up.
            let floors_kg: f64 = m[i..].iter().sum();
            let contents = self.contents.iter().filter(|contents| contents.floor > i);
            let carried_kg = contents.fold(floors_kg, |sum, contents| sum + contents.mass_kg);
            below_m -= carried_kg * slope / k[i];
            q[i] = below_m;
        }
        q
    }

    /// Displacements at t = 0 in m of the [oscillators](Structure::oscillators_in_plane) of a structure by its modes: as
    /// given along y, else those that the slope's pull holds at rest; none of a frame.
    #[must_use]
    pub fn initial_oscillators_in_plane_m(&self) -> Vec<f64> {
        if let Some(q) = self.along_y.as_ref().and_then(|y| y.initial.storey_displacement_m.clone())
        {
            return q;
        }
        let [x, y] = self.slope_in_plane_m_per_s2();
        let modes = self.structure.as_ref().map(Structure::oscillators_in_plane);
        let of_mode = |mode: OscillatorInPlane| {
            let omega = mode.frequency_rad_per_s;
            0.0 - (x * mode.direction[0] + y * mode.direction[1]) / (omega * omega)
        };
        modes.into_iter().flatten().map(of_mode).collect()
    }

    /// Storey velocities at t = 0 in m/s: as given, else 0.
    #[must_use]
    pub fn initial_storey_velocity_m_per_s(&self) -> Vec<f64> {
        let at_rest = || vec![0.0; self.storeys()];
        self.initial.storey_velocity_m_per_s.clone().unwrap_or_else(at_rest)
    }
}

fn check_start(initial: &InitialState, storeys: usize) -> Result<(), ModelError> {
    finite("initial sliding_displacement_m", initial.sliding_displacement_m)?;
    finite("initial sliding_velocity_m_per_s", initial.sliding_velocity_m_per_s)?;
    if let Some(q) = &initial.storey_displacement_m {
        each("initial storey_displacement_m", storeys, q, finite)?;
    }
    if let Some(v) = &initial.storey_velocity_m_per_s {
        each("initial storey_velocity_m_per_s", storeys, v, finite)?;
    }
    Ok(())
}

fn each(
    quantity: &'static str,
    expected: usize,
    values: &[f64],
    check: fn(&'static str, f64) -> Result<(), ModelError>,
) -> Result<(), ModelError> {
    if values.len() != expected {
        return Err(ModelError::WrongCount { quantity, expected, found: values.len() });
    }
    values.iter().try_for_each(|&value| check(quantity, value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slider::{Direction, Surface, SurfacesInSeries};

    /// `φ = (s + Σ μ R)/Σ R` where all slide, and the friction of a flat surface where there is one.
    #[test]
    fn surfaces_that_all_slide_are_one() {
        let surface = |radius_m, friction| Surface { radius_m, friction, travel_m: Some(0.1) };
        let one = |surfaces| {
            let series = SurfacesInSeries::new(surfaces, 1.5).unwrap();
            let block = Block { mass_kg: 700.0, width_m: Some(1.0), height_m: None };
            let slider = Slider::in_series(series);
            let whole = Model::new(block, slider, Frame::none(), 9.81, InitialState::rest());
            let simple = whole.unwrap().simple_in_plane().unwrap();
            assert_eq!(simple.total_mass_kg(), 700.0);
            simple.slider().clone()
        };
        let pendulum = one(vec![surface(Some(1.0), 0.25), surface(Some(3.0), 0.5)]);
        let friction = Friction::new(1.5 * 0.4375, 0.4375).unwrap();
        assert_eq!(pendulum, Slider::pendulum(friction, 4.0));
        let flat = one(vec![surface(Some(1.0), 0.25), surface(None, 0.5)]);
        assert_eq!(flat, Slider::new(Friction::new(0.75, 0.5).unwrap()));
        let plain = Model::rigid_block(9.0, Friction::new(0.2, 0.1).unwrap()).unwrap();
        assert_eq!(plain.simple_in_plane(), None);
    }

    fn with(stop: Stop) -> Result<Model, ModelError> {
        let friction = Friction::new(0.2, 0.1).unwrap();
        let plain = Model::rigid_block(10.0, friction.clone()).unwrap();
        let slider = Slider { ends: stop.into(), ..Slider::new(friction) };
        Model::new(*plain.block(), slider, Frame::none(), 9.81, InitialState::rest())
    }

    #[test]
    fn stops_are_checked() {
        let stop = Stop::elastic;
        let good = stop([Some(0.1), None], 1e5, 0.0);
        let model = with(good).unwrap();
        assert_eq!(model.stop(), Some(&good));
        assert_eq!(good.gap_towards(Direction::Positive), Some(0.1));
        assert_eq!(good.gap_towards(Direction::Negative), None);
        for (stop, quantity) in [
            (stop([None; 2], 1e5, 0.0), "stop gap_m"),
            (stop([Some(0.1), Some(-0.1)], 1e5, 0.0), "stop gap_m"),
            (stop([Some(f64::NAN), None], 1e5, 0.0), "stop gap_m"),
            (stop([Some(0.1); 2], 0.0, 0.0), "stop stiffness_n_per_m"),
            (stop([Some(0.1); 2], 1e5, -1.0), "stop damper_n_s_per_m"),
        ] {
            let error = with(stop).unwrap_err().to_string();
            assert!(error.starts_with(quantity), "{error}");
        }
    }
}
