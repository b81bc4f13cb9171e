//! What the outside gives for the next communication step.

use super::Simulation;
use crate::base::quantity::BoundaryIndex;
use crate::engine::state::BoundaryState;
use crate::engine::state::fluid::FluidField;

impl Simulation {
    /// Sets the input of an axis for the next interval, along x, y, z (0 to 2) or about them (3 to 5): where a driven axis
    /// is to be at its end \[m, rad\] or how fast it moves \[m/s, rad/s\], the load on one that forces move \[N, N m\], the force
    /// that a servo is to reach \[N\]. Those that move with the boundary get it, too.
    pub fn set_input(&mut self, boundary: BoundaryIndex, axis: usize, value: f64) {
        self.each_led(boundary, |moved| {
            moved.target[axis] = value;
            moved.target_rate[axis] = 0.0;
            if let Some(acceleration) = moved.target_acceleration.get_mut(axis) {
                *acceleration = 0.0;
            }
        });
    }

    /// Does something with the state of a boundary and of all that move with it.
    fn each_led(&mut self, leader: BoundaryIndex, mut what: impl FnMut(&mut BoundaryState)) {
        let boundaries = self.scene.boundaries.iter().zip(&mut self.state.boundaries).enumerate();
        for (place, (boundary, moved)) in boundaries {
            if place == leader.index() || boundary.moves_with == Some(leader) {
                what(moved);
            }
        }
    }

    /// Sets the input of a component of the strain of the periodic cell for the next interval: the strain at its end, or the stress that
    /// a servo is to reach then \[Pa\]. Components are xx, yy, zz, xy, xz, yz.
    pub fn set_strain(&mut self, component: usize, value: f64) {
        if let Some(cell) = &mut self.state.cell {
            (cell.target[component], cell.target_rate[component]) = (value, 0.0);
        }
    }

    /// The rate of that value over the next interval.
    pub fn set_strain_rate(&mut self, component: usize, rate: f64) {
        if let Some(cell) = &mut self.state.cell {
            cell.target_rate[component] = rate;
        }
    }

    /// Sets where a node of a mesh, by its number from 0, is to be at the end of the next interval, along x, y or z \[m\].
    pub fn set_node(&mut self, boundary: BoundaryIndex, (node, axis): (usize, usize), value: f64) {
        if let Some(nodes) = self.state.nodes_of_mut(boundary.index()) {
            nodes.target[node][axis] = value;
            nodes.target_rate[node][axis] = 0.0;
        }
    }

    /// The rate of that value over the next interval \[m/s\].
    pub fn set_node_rate(&mut self, boundary: BoundaryIndex, (node, axis): (usize, usize), rate: f64) {
        if let Some(nodes) = self.state.nodes_of_mut(boundary.index()) {
            nodes.target_rate[node][axis] = rate;
        }
    }

    /// The rate of that value over the next interval: it then ends at the value plus rate × interval.
    pub fn set_input_rate(&mut self, boundary: BoundaryIndex, axis: usize, rate: f64) {
        self.each_led(boundary, |moved| moved.target_rate[axis] = rate);
    }

    /// Sets the thermal input of a boundary for the next interval: its temperature at the end \[K\] or, where it has a heat capacity,
    /// the heat flow from the outside \[W\].
    pub fn set_heat(&mut self, boundary: BoundaryIndex, value: f64) {
        self.set_thermal((boundary, None), [value, 0.0]);
    }

    /// The rate of that value over the next interval \[K/s, W/s\].
    pub fn set_heat_rate(&mut self, boundary: BoundaryIndex, rate: f64) {
        self.set_thermal_rate((boundary, None), rate);
    }

    /// Sets the temperature of a node of a mesh, by its number from 0, at the end of the next interval \[K\].
    pub fn set_node_temperature(&mut self, boundary: BoundaryIndex, node: usize, value: f64) {
        self.set_thermal((boundary, Some(node)), [value, 0.0]);
    }

    /// The rate of that value over the next interval \[K/s\].
    pub fn set_node_temperature_rate(&mut self, boundary: BoundaryIndex, node: usize, rate: f64) {
        self.set_thermal_rate((boundary, Some(node)), rate);
    }

    /// Sets a thermal input and its rate.
    fn set_thermal(&mut self, (boundary, node): (BoundaryIndex, Option<usize>), [value, rate]: [f64; 2]) {
        if let Some(it) = self.state.heat.as_mut().and_then(|heat| heat.surface_mut(boundary.index(), node)) {
            (it.target, it.target_rate) = (value, rate);
        }
    }

    /// Sets the rate of a thermal input.
    fn set_thermal_rate(&mut self, (boundary, node): (BoundaryIndex, Option<usize>), rate: f64) {
        if let Some(it) = self.state.heat.as_mut().and_then(|heat| heat.surface_mut(boundary.index(), node)) {
            it.target_rate = rate;
        }
    }

    /// Sets a component of what the fluid is given in a cell of its grid, by its number from 0, for the end of the next interval: its
    /// velocity \[m/s\], the gradient of its pressure \[Pa/m\]. Without a grid there is one cell.
    pub fn set_fluid(&mut self, field: FluidField, (cell, axis): (usize, usize), value: f64) {
        if let Some(course) = self.state.fluid.as_mut().map(|fluid| fluid.given_mut(field)) {
            (course.target[cell][axis], course.target_rate[cell][axis]) = (value, 0.0);
        }
    }

    /// The rate of that value over the next interval, per second.
    pub fn set_fluid_rate(&mut self, field: FluidField, (cell, axis): (usize, usize), rate: f64) {
        if let Some(course) = self.state.fluid.as_mut().map(|fluid| fluid.given_mut(field)) {
            course.target_rate[cell][axis] = rate;
        }
    }

    /// The second derivative of that value over the next interval, along x, y or z: the axis then moves at this acceleration, and ends
    /// at the value plus rate × interval + ½ acceleration × interval² \[m/s²\].
    pub fn set_input_acceleration(&mut self, boundary: BoundaryIndex, axis: usize, acceleration: f64) {
        self.each_led(boundary, |moved| moved.target_acceleration[axis] = acceleration);
    }
}
