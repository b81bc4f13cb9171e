//! The package and its description.

use super::*;
use crate::interface::Causality;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::sync::atomic::{AtomicU32, Ordering};

/// A group, a driven plane and a plane at rest.
const SCENE: &str = r#"
gravity = [0.0, 0.0, -9.81]

[run]
end = 0.25
step = 1.0e-5

[material.glass]
youngs_modulus = 5.0e7
poissons_ratio = 0.3
density = 2500.0

[pair.glass.glass]
restitution = 0.5

[contact.touch.normal.hertz]

[particles.bed]
material = "glass"
file = "../some where/bed.csv"

[boundary.floor]
plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
material = "glass"
motion = { driven = ["x", "z"] }

[boundary.side]
plane = { point = [-1.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
material = "glass"

[boundary.grip]
particles = { set = "bed", box = [[-1.0, -1.0, 0.025], [1.0, 1.0, 1.0]] }
"#;

/// Its particles.
const BED: &str = "id,x,y,z,radius\n1,0.0,0.0,0.0099,0.01\n2,0.0,0.0,0.0297,0.01\n";

/// The scene's source.
fn source() -> Source {
    let files = BTreeMap::from([("../some where/bed.csv".to_owned(), BED.as_bytes().to_vec())]);
    Source { name: "scene.toml".to_owned(), text: SCENE.to_owned(), files }
}

/// A new folder that is removed when it is dropped.
struct Folder(PathBuf);

impl Folder {
    /// Makes one.
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("cograin-export-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Writes something that passes for the library.
    fn library(&self) -> PathBuf {
        let path = self.0.join("library.so");
        fs::write(&path, format!("\0{LIBRARY_MARK}\0")).unwrap();
        path
    }

    /// Exports the scene and reads the unit.
    fn exported(&self, name: &str, state: Option<&State>) -> BTreeMap<String, Vec<u8>> {
        let (source, output) = (source(), self.0.join(name));
        let scene = Scene::from_source(&source).unwrap();
        export(&source, &scene, state, &self.library(), &output).unwrap();
        let mut archive = zip::ZipArchive::new(fs::File::open(output).unwrap()).unwrap();
        let mut entries = BTreeMap::new();
        for index in 0..archive.len() {
            let mut entry = archive.by_index(index).unwrap();
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).unwrap();
            entries.insert(entry.name().unwrap().into_owned(), bytes);
        }
        entries
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// An element of the description: its name, its attributes, and how deep it stands.
struct Element {
    /// Name.
    name: String,
    /// Attributes.
    attributes: BTreeMap<String, String>,
    /// Number of elements around it.
    depth: usize,
}

impl Element {
    /// An attribute.
    fn get(&self, name: &str) -> Option<&str> {
        self.attributes.get(name).map(String::as_str)
    }
}

/// The elements of a description, in order.
fn elements(xml: &[u8]) -> Vec<Element> {
    let text = std::str::from_utf8(xml).unwrap();
    let mut reader = Reader::from_str(text);
    let (mut elements, mut depth) = (Vec::new(), 0);
    loop {
        let event = reader.read_event().unwrap();
        if let Event::Start(tag) | Event::Empty(tag) = &event {
            let attributes = tag.attributes().map(|attribute| {
                let attribute = attribute.unwrap();
                let key = AsRef::<str>::as_ref(&attribute.key).to_owned();
                (key, quick_xml::escape::unescape(&attribute.value).unwrap().into_owned())
            });
            let name = AsRef::<str>::as_ref(&tag.name()).to_owned();
            elements.push(Element { name, attributes: attributes.collect(), depth });
        }
        match event {
            Event::Start(_) => depth += 1,
            Event::End(_) => depth -= 1,
            Event::Eof => return elements,
            _ => {}
        }
    }
}

/// The description of the scene.
fn description() -> Vec<Element> {
    elements(&Folder::new().exported("unit.fmu", None)["modelDescription.xml"])
}

/// Elements of one name that stand below the first element of another name.
fn below<'a>(elements: &'a [Element], parent: &str, name: &'a str) -> Vec<&'a Element> {
    let start = elements.iter().position(|element| element.name == parent).unwrap();
    let depth = elements[start].depth;
    let inner = elements[start + 1..].iter().take_while(|element| element.depth > depth);
    inner.filter(|element| element.name == name).collect()
}

#[test]
fn elements_stand_in_the_order_of_the_schema() {
    let elements = description();
    let order: Vec<&str> =
        elements.iter().filter(|element| element.depth == 1).map(|element| element.name.as_str()).collect();
    let right =
        ["CoSimulation", "UnitDefinitions", "LogCategories", "DefaultExperiment", "ModelVariables", "ModelStructure"];
    assert_eq!(order, right);
}

#[test]
fn the_table_and_the_description_list_the_same_variables() {
    let elements = description();
    let scene = Scene::from_source(&source()).unwrap();
    let interface = Interface::of(&scene);
    let written = below(&elements, "ModelVariables", "ScalarVariable");
    assert_eq!(written.len(), interface.variables().len());
    for (index, (element, variable)) in written.into_iter().zip(interface.variables()).enumerate() {
        assert_eq!(element.get("name"), Some(variable.name.as_str()));
        assert_eq!(element.get("valueReference"), Some(index.to_string().as_str()));
        assert!(element.get("variability").is_some(), "{}: the default would be continuous", variable.name);
        let initial = match (variable.causality, variable.start) {
            (Causality::Input, _) => None,
            (Causality::Output, Some(_)) | (Causality::Parameter, _) => Some("exact"),
            (Causality::Output, None) => Some("calculated"),
        };
        assert_eq!(element.get("initial"), initial, "{}", variable.name);
    }
}

#[test]
fn start_values_stand_where_the_standard_wants_them() {
    let elements = description();
    for pair in elements.windows(2).filter(|pair| pair[0].name == "ScalarVariable") {
        let wanted = pair[0].get("causality") == Some("input") || pair[0].get("initial") == Some("exact");
        assert_eq!(pair[1].get("start").is_some(), wanted, "{:?}", pair[0].get("name"));
    }
}

#[test]
fn every_unit_that_is_used_is_defined_and_every_real_has_one() {
    let elements = description();
    let defined: Vec<&str> =
        below(&elements, "UnitDefinitions", "Unit").iter().filter_map(|unit| unit.get("name")).collect();
    for real in elements.iter().filter(|element| element.name == "Real") {
        let unit = real.get("unit").expect("every real has a unit");
        assert!(defined.contains(&unit), "{unit} is not defined");
        assert!(real.get("quantity").is_some());
    }
    assert_eq!(below(&elements, "UnitDefinitions", "BaseUnit").len(), defined.len());
}

#[test]
fn the_structure_counts_from_one_and_knows_what_the_start_depends_on() {
    let elements = description();
    let variables = below(&elements, "ModelVariables", "ScalarVariable");
    let positions = |wanted: &dyn Fn(&Element) -> bool| -> Vec<String> {
        let found = variables.iter().enumerate().filter(|(_, element)| wanted(element));
        found.map(|(index, _)| (index + 1).to_string()).collect()
    };
    let listed = |list: &str| -> Vec<String> {
        below(&elements, list, "Unknown").iter().map(|it| it.get("index").unwrap().to_owned()).collect()
    };
    assert_eq!(listed("Outputs"), positions(&|it| it.get("causality") == Some("output")));
    assert_eq!(listed("InitialUnknowns"), positions(&|it| it.get("initial") == Some("calculated")));

    let place = |name: &str| (variables.iter().position(|it| it.get("name") == Some(name)).unwrap() + 1).to_string();
    let dependencies = |list: &str, name: &str| {
        let place = place(name);
        let unknown = below(&elements, list, "Unknown").into_iter().find(|it| it.get("index") == Some(place.as_str()));
        unknown.unwrap().get("dependencies").unwrap().to_owned()
    };
    // The folder of the frames changes no value.
    let is_number = |it: &Element| it.get("causality") == Some("parameter") && it.get("name") != Some("run.frames");
    let parameters = positions(&is_number).join(" ");
    let given = format!("{} {} {parameters}", place("floor.displacement.x"), place("floor.displacement.z"));
    let inputs = format!("{} {}", place("floor.displacement.x"), place("floor.displacement.z"));
    assert_eq!(dependencies("Outputs", "floor.force.z"), inputs, "the inputs that it has derivatives by");
    assert_eq!(dependencies("Outputs", "floor.work"), inputs);
    assert_eq!(dependencies("Outputs", "contacts.count"), "");
    assert_eq!(dependencies("InitialUnknowns", "floor.force.z"), given);
    assert_eq!(dependencies("InitialUnknowns", "floor.work"), parameters);
}

#[test]
fn the_default_experiment_ends_with_the_scene() {
    let elements = description();
    let experiment = elements.iter().find(|element| element.name == "DefaultExperiment").unwrap();
    assert_eq!((experiment.get("startTime"), experiment.get("stopTime")), (Some("0.0"), Some("0.25")));
}

#[test]
fn two_exports_give_the_same_bytes() {
    let folder = Folder::new();
    folder.exported("unit.fmu", None);
    let first = fs::read(folder.0.join("unit.fmu")).unwrap();
    folder.exported("unit.fmu", None);
    assert!(first == fs::read(folder.0.join("unit.fmu")).unwrap());
}

#[test]
fn resources_come_back_as_they_went_in_whatever_the_files_are_called() {
    let folder = Folder::new();
    for (path, bytes) in folder.exported("unit.fmu", None) {
        let inside = folder.0.join(path);
        fs::create_dir_all(inside.parent().unwrap()).unwrap();
        fs::write(inside, bytes).unwrap();
    }
    assert_eq!(read_resources(&folder.0.join("resources")).unwrap(), Contents { source: source(), state: None });
    assert!(folder.0.join("resources/files/0_bed.csv").is_file());
}

#[test]
fn the_identifier_is_a_name_in_c() {
    for (path, name) in [("a/loaded_beam.fmu", "loaded_beam"), ("2 beams-é.fmu", "_2_beams__"), ("x.y.fmu", "x_y")] {
        assert_eq!(identifier(Path::new(path)), name);
    }
}

#[test]
fn the_identity_follows_scene_files_and_state() {
    let (text, mut file) = (source(), source());
    let other = Source { text: SCENE.replace("0.25", "0.26"), ..source() };
    file.files.insert("more.csv".to_owned(), Vec::new());
    let identities = [identity(&text, None), identity(&other, None), identity(&file, None), identity(&text, Some(&[]))];
    for (index, one) in identities.iter().enumerate() {
        assert!(!identities[index + 1..].contains(one), "two identities are equal");
    }
    assert_eq!(identity(&text, None), identity(&source(), None));
}

#[test]
fn nothing_is_left_where_a_unit_cannot_be_written() {
    let folder = Folder::new();
    let (source, library) = (source(), folder.library());
    let scene = Scene::from_source(&source).unwrap();
    let missing = folder.0.join("missing/unit.fmu");
    let message = export(&source, &scene, None, &library, &missing).unwrap_err().to_string();
    assert!(message.contains("missing/unit.fmu"), "{message}");
    fs::create_dir(folder.0.join("taken.fmu")).unwrap();
    assert!(export(&source, &scene, None, &library, &folder.0.join("taken.fmu")).is_err());
    let left: Vec<_> = fs::read_dir(&folder.0).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "{left:?}: only the library and the folder in the way are right");
}

#[test]
fn a_unit_that_begins_in_a_state_holds_it_and_names_its_displacements() {
    let scene = std::sync::Arc::new(Scene::from_source(&source()).unwrap());
    let mut simulation = crate::engine::simulation::Simulation::new(std::sync::Arc::clone(&scene)).unwrap();
    simulation.set_input(crate::base::quantity::BoundaryIndex(0), 2, 1.0e-5);
    simulation.advance(1.0e-3).unwrap();
    let unit = Folder::new().exported("unit.fmu", Some(simulation.state()));
    let begun = State::from_bytes(&unit["resources/state.bin"], scene.fingerprint).unwrap();
    assert_eq!(begun, *simulation.state());
    let elements = elements(&unit["modelDescription.xml"]);
    let place = elements.iter().position(|it| it.get("name") == Some("floor.displacement.z")).unwrap();
    assert_eq!(elements[place + 1].get("start"), Some("1e-5"));
}
