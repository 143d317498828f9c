//! Models in quantities with units, as a person would say them.

use core::f64::consts::TAU;

use super::{Block, Contents, Damping, Frame, InitialState, Model, Slider, Stop};
use crate::error::ModelError;
use crate::slider::{
    Bearing, Direction, Ends, Friction, PressureLaw, RateLaw, Restoring, SurfacesInSeries,
};
use crate::units::{Dimension, STANDARD_GRAVITY_M_PER_S2, parse_quantity};

/// Builds a [`Model`] from quantities with units, all that [`crate::units`] knows.
///
/// A block and its friction are needed, damping where there are storeys; what else is not said is not
/// there. [`build`](Self::build) tells the first that is wrong. Programs that have their numbers in SI
/// call [`Model::new`].
///
/// # Examples
/// ```
/// use slipstick_dynamics::model::Model;
///
/// // A storey of 1.625 Hz on a block on a spring.
/// let model = Model::builder()
///     .block("325 kg")
///     .friction(0.020, 0.012)
///     .spring("143 kN/m")
///     .oscillator("45 kg", "1.625 Hz", 0.01)
///     .build()?;
/// assert_eq!(model.total_mass_kg(), 370.0);
///
/// let error = Model::builder().block("325 kN").friction(0.1, 0.1).build().unwrap_err();
/// let expected = "block mass: expected a mass, such as \"325 kg\", found a force, \"325 kN\"";
/// assert_eq!(error.to_string(), expected);
/// # Ok::<(), slipstick_dynamics::error::ModelError>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct ModelBuilder {
    block_kg: Option<f64>,
    block_width_m: Option<f64>,
    block_height_m: Option<f64>,
    friction: Option<Friction>,
    pressure: Option<PressureLaw>,
    restoring: Restoring,
    damper_n_s_per_m: f64,
    tilt_rad: f64,
    tilt_y_rad: f64,
    gap_m: Option<f64>,
    stop: Option<Stop>,
    frame: Frame,
    damping: Option<Damping>,
    gravity_m_per_s2: f64,
    initial: InitialState,
    series: Option<SurfacesInSeries>,
    contents: Vec<Contents>,
    /// The first that could not be read.
    refused: Option<ModelError>,
}

impl Model {
    /// Starts a [`ModelBuilder`].
    pub fn builder() -> ModelBuilder {
        ModelBuilder {
            block_kg: None,
            block_width_m: None,
            block_height_m: None,
            friction: None,
            pressure: None,
            restoring: Restoring::None,
            damper_n_s_per_m: 0.0,
            tilt_rad: 0.0,
            tilt_y_rad: 0.0,
            gap_m: None,
            stop: None,
            frame: Frame::none(),
            damping: None,
            gravity_m_per_s2: STANDARD_GRAVITY_M_PER_S2,
            initial: InitialState::rest(),
            series: None,
            contents: Vec::new(),
            refused: None,
        }
    }
}

impl ModelBuilder {
    /// The rigid block that slides, by its mass `M1`.
    pub fn block(mut self, mass: &str) -> Self {
        self.block_kg = Some(self.read("block mass", mass, Dimension::Mass));
        self
    }

    /// Width of the block along x; with storey heights the overturning ratio is reported.
    pub fn block_width(mut self, width: &str) -> Self {
        self.block_width_m = Some(self.read("block width", width, Dimension::Length));
        self
    }

    /// Height of the block, where its own inertia counts for overturning.
    pub fn block_height(mut self, height: &str) -> Self {
        self.block_height_m = Some(self.read("block height", height, Dimension::Length));
        self
    }

    /// Static and kinetic coefficients of friction, the same in both directions.
    pub fn friction(mut self, fixed: f64, kinetic: f64) -> Self {
        let friction = Friction::new(fixed, kinetic).map_err(|error| self.refuse(error));
        self.friction = friction.ok();
        self
    }

    /// Friction that differs by direction or follows the speed.
    pub fn friction_law(mut self, friction: Friction) -> Self {
        self.friction = Some(friction);
        self
    }

    /// Kinetic friction that follows the sliding speed, under a static coefficient that is at least
    /// that at rest.
    pub fn friction_by_speed(mut self, fixed: f64, law: RateLaw) -> Self {
        let friction = Friction::by_speed([fixed; 2], law).map_err(|error| self.refuse(error));
        self.friction = friction.ok();
        self
    }

    /// Friction that falls as the pressure grows, `μ (p/reference)^(−exponent)`: the pressure under the weight alone, and the
    /// reference at which the coefficients hold that are said beside it.
    ///
    /// # Examples
    /// ```
    /// use slipstick_dynamics::model::Model;
    /// use slipstick_dynamics::slider::Direction;
    ///
    /// // Coefficients measured at 20 MPa, a bearing under 45 MPa at rest.
    /// let model = Model::builder()
    ///     .block("325 kg")
    ///     .friction(0.06, 0.05)
    ///     .pressure("45 MPa", "20 MPa", 0.2)
    ///     .build()?;
    /// let at_rest = model.slider().friction().map(|of| of.static_coefficient(Direction::Positive));
    /// assert!((at_rest.unwrap_or(0.0) - 0.06 * 0.850_283).abs() < 1e-7);
    /// # Ok::<(), slipstick_dynamics::error::ModelError>(())
    /// ```
    pub fn pressure(mut self, at_rest: &str, reference: &str, exponent: f64) -> Self {
        let at_rest_pa = self.read("pressure", at_rest, Dimension::Pressure);
        let reference_pa = self.read("reference pressure", reference, Dimension::Pressure);
        let law = PressureLaw::new(at_rest_pa, reference_pa, exponent);
        self.pressure = law.map_err(|error| self.refuse(error)).ok();
        self
    }

    /// Surfaces in series, which have friction and radii of their own: they exclude
    /// others, and a spring.
    pub fn surfaces(mut self, series: SurfacesInSeries) -> Self {
        self.series = Some(series);
        self
    }

    /// A spring between table and block, by its stiffness `K1`; takes the place of a pendulum.
    pub fn spring(mut self, stiffness: &str) -> Self {
        let stiffness_n_per_m = self.read("spring", stiffness, Dimension::Stiffness);
        self.restoring = Restoring::Spring { stiffness_n_per_m };
        self
    }

    /// A pendulum slider of radius `R`, whose spring is `N/R`; takes the place of a spring.
    pub fn radius(mut self, radius: &str) -> Self {
        self.restoring =
            Restoring::Pendulum { radius_m: self.read("radius", radius, Dimension::Length) };
        self
    }

    /// A damper `C1` between table and block.
    pub fn damper(mut self, damper: &str) -> Self {
        self.damper_n_s_per_m = self.read("damper", damper, Dimension::Damper);
        self
    }

    /// Tilt of the surface, positive uphill towards +x.
    pub fn tilt(mut self, tilt: &str) -> Self {
        self.tilt_rad = self.read("tilt", tilt, Dimension::Angle);
        self
    }

    /// Tilt of the surface along y, positive uphill towards +y.
    pub fn tilt_y(mut self, tilt: &str) -> Self {
        self.tilt_y_rad = self.read("tilt_y", tilt, Dimension::Angle);
        self
    }

    /// Sliding displacement that the detailing allows; reported only, nothing is struck.
    pub fn gap(mut self, gap: &str) -> Self {
        self.gap_m = Some(self.read("gap", gap, Dimension::Length));
        self
    }

    /// What the block strikes at the end of its travel; excludes a gap.
    pub fn stop(mut self, stop: Stop) -> Self {
        self.stop = Some(stop);
        self
    }

    /// A storey on what stands already; its damping is that of all, by
    /// [`damping_ratio`](Self::damping_ratio) or [`dampers`](Self::dampers).
    pub fn storey(mut self, mass: &str, stiffness: &str) -> Self {
        let mass_kg = self.read("storey mass", mass, Dimension::Mass);
        let stiffness_n_per_m = self.read("storey stiffness", stiffness, Dimension::Stiffness);
        self.frame.masses_kg.push(mass_kg);
        self.frame.stiffnesses_n_per_m.push(stiffness_n_per_m);
        self
    }

    /// A structure of one storey, by its fixed-base frequency and damping ratio.
    pub fn oscillator(mut self, mass: &str, frequency: &str, damping_ratio: f64) -> Self {
        let mass_kg = self.read("storey mass", mass, Dimension::Mass);
        let omega = TAU * self.read("storey frequency", frequency, Dimension::Frequency);
        self.frame.masses_kg = vec![mass_kg];
        self.frame.stiffnesses_n_per_m = vec![mass_kg * omega * omega];
        self.damping_ratio(damping_ratio)
    }

    /// Ratio of critical damping in every fixed-base mode of the storeys.
    pub fn damping_ratio(mut self, ratio: f64) -> Self {
        self.damping = Some(Damping::Ratio(ratio));
        self
    }

    /// Dampers between neighbouring floors, one a storey, from the block up.
    pub fn dampers(mut self, dampers: &[&str]) -> Self {
        let each = |damper: &&str| self.read("storey damper", damper, Dimension::Damper);
        let dampers = dampers.iter().map(each).collect();
        self.damping = Some(Damping::Dampers(dampers));
        self
    }

    /// Heights of the storeys, from the block up.
    pub fn heights(mut self, heights: &[&str]) -> Self {
        let each = |height: &&str| self.read("storey height", height, Dimension::Length);
        self.frame.heights_m = Some(heights.iter().map(each).collect());
        self
    }

    /// Something that stands unfastened on the block or on a floor.
    pub fn contents(mut self, contents: Contents) -> Self {
        self.contents.push(contents);
        self
    }

    /// Acceleration of gravity, where it is not 9.80665 m/s².
    pub fn gravity(mut self, gravity: &str) -> Self {
        self.gravity_m_per_s2 = self.read("gravity", gravity, Dimension::Acceleration);
        self
    }

    /// The state at t = 0, where it is not rest.
    pub fn initial(mut self, initial: InitialState) -> Self {
        self.initial = initial;
        self
    }

    /// The checked model.
    ///
    /// # Errors
    /// [`ModelError::Quantity`] for the first quantity that cannot be read, [`ModelError::Missing`] for
    /// a block, friction or damping that is not said, [`ModelError::OutOfRange`] for a gap beside a stop, or a
    /// pressure beside surfaces in series, otherwise as [`Model::new`] and [`Model::with_contents`].
    pub fn build(self) -> Result<Model, ModelError> {
        if let Some(error) = self.refused {
            return Err(error);
        }
        let missing = |quantity, expected| ModelError::Missing { quantity, expected };
        let mass_kg = self.block_kg.ok_or(missing("block mass", "a mass with its unit"))?;
        let friction = match (self.friction, self.pressure) {
            (Some(friction), Some(law)) => Some(friction.under_pressure(law)?),
            (friction, _) => friction,
        };
        if let (Some(_), Some(law)) = (&self.series, self.pressure) {
            let (quantity, expected) = ("pressure", "none beside surfaces in series");
            let found = law.at_rest_pa();
            return Err(ModelError::OutOfRange { quantity, expected, found });
        }
        let bearing = match (self.series, friction) {
            (Some(series), None) if self.restoring == Restoring::None => Bearing::InSeries(series),
            (Some(_), friction) => {
                let (quantity, found) = match (self.restoring, friction) {
                    (Restoring::Spring { stiffness_n_per_m }, _) => ("spring", stiffness_n_per_m),
                    (Restoring::Pendulum { radius_m }, _) => ("radius", radius_m),
                    (Restoring::None, friction) => {
                        let fixed =
                            |friction: Friction| friction.static_coefficient(Direction::Positive);
                        ("friction", friction.map_or(0.0, fixed))
                    }
                };
                let expected = "none beside surfaces in series, which have their own";
                return Err(ModelError::OutOfRange { quantity, expected, found });
            }
            (None, Some(friction)) => Bearing::Surface { friction, restoring: self.restoring },
            (None, None) => return Err(missing("friction", "two coefficients or surfaces")),
        };
        let ends = match (self.stop, self.gap_m) {
            (Some(_), Some(found)) => {
                let (quantity, expected) =
                    ("slider gap_m", "no gap beside a stop, which has its own");
                return Err(ModelError::OutOfRange { quantity, expected, found });
            }
            (Some(stop), None) => Ends::Stop(stop),
            (None, gap_m) => Ends::Open { gap_m },
        };
        let damping = match self.damping {
            Some(damping) => damping,
            None if self.frame.masses_kg.is_empty() => Damping::Ratio(0.0),
            None => return Err(missing("storey damping", "a ratio or dampers")),
        };
        let block = Block { mass_kg, width_m: self.block_width_m, height_m: self.block_height_m };
        let Self { damper_n_s_per_m, tilt_rad, tilt_y_rad, .. } = self;
        let slider = Slider { bearing, damper_n_s_per_m, tilt_rad, tilt_y_rad, ends };
        let frame = Frame { damping, ..self.frame };
        Model::new(block, slider, frame, self.gravity_m_per_s2, self.initial)?
            .with_contents(self.contents)
    }

    /// A quantity in SI; 0 where it cannot be read, which [`build`](Self::build) then tells.
    fn read(&mut self, quantity: &'static str, text: &str, dimension: Dimension) -> f64 {
        match parse_quantity(text, dimension) {
            Ok(value) => value,
            Err(error) => {
                self.refuse(ModelError::Quantity { quantity, error });
                0.0
            }
        }
    }

    fn refuse(&mut self, error: ModelError) {
        self.refused.get_or_insert(error);
    }
}
