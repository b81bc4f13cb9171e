//! `documentation/index.html`: what the unit is, for people.

use super::description::{Model, about};
use crate::interface::Causality;
use crate::scene::{Boundary, Scene};
use quick_xml::escape::escape;
use std::fmt::Write;

/// The page.
pub(super) fn write(model: &Model<'_>) -> String {
    let mut rows = String::new();
    for variable in model.interface.variables().iter().filter(|variable| variable.node().is_none_or(|node| node == 0)) {
        let causality = match variable.causality {
            Causality::Input => "input",
            Causality::Output => "output",
            Causality::Parameter => "parameter",
        };
        // writing to a string does not fail
        let _ = writeln!(
            rows,
            "<tr><td><code>{}</code></td><td>{causality}</td><td>{}</td><td>{}</td></tr>",
            escape(variable.name.as_str()),
            escape(variable.quantity.unit().unwrap_or("")),
            escape(variable.description.as_str()),
        );
    }
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{name}</title></head>\n<body>\n\
         <h1>{name}</h1>\n<p>{about}. FMI 2.0 co-simulation, made by cograin {version}; the scene is \
         <code>resources/scene.toml</code>.</p>\n\
         <p>Forces and moments are those of the particles on the boundary: a bed that rests on a floor whose normal \
         points up gives a negative <code>force.z</code>. Moments are taken about the boundary's moved reference \
         point, in global axes. A displacement given before a communication step is reached at its end; it changes \
         no output before that step. At initialisation it is taken without motion. Over each communication step the \
         change of <code>work</code> is &minus;<code>mean_force</code> times the change of displacement.</p>\n{nodes}\
         <table>\n<tr><th>variable</th><th>causality</th><th>unit</th><th>meaning</th></tr>\n{rows}</table>\n\
         </body>\n</html>\n",
        nodes = nodes(model.scene),
        name = escape(model.identifier),
        about = escape(about(model.scene)),
        version = env!("CARGO_PKG_VERSION"),
    )
}

/// What is said of meshes whose nodes the outside moves.
fn nodes(scene: &Scene) -> String {
    let meshes = scene.boundaries.iter().filter(|boundary| boundary.driven_nodes() > 0);
    let line = |mesh: &Boundary| {
        format!(
            "<p><code>{name}</code> has {count} nodes, of which the table shows the first; <code>resources/{name}.nodes.csv</code> has \
             their numbers and places, <code>resources/{name}.triangles.csv</code> the triangles between them.</p>\n",
            name = mesh.name,
            count = mesh.driven_nodes()
        )
    };
    meshes.map(line).collect()
}
