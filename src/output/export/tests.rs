//! The package and its description.

use super::*;
use crate::interface::Causality;
use crate::output::scratch::Scratch;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;

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

/// A new folder.
struct Folder(Scratch);

impl Folder {
    /// Makes one.
    fn new() -> Self {
        Self(Scratch::new())
    }

    /// Writes something that passes for the library.
    fn library(&self) -> Libraries {
        let path = self.0.join("library.so");
        fs::write(&path, sample_library::Sample::LINUX.bytes()).unwrap();
        Libraries { paths: vec![path], platforms: Vec::new() }
    }

    /// Exports the scene and reads the unit.
    fn exported(&self, name: &str, state: Option<&State>) -> BTreeMap<String, Vec<u8>> {
        let (source, output) = (source(), self.0.join(name));
        let scene = Arc::new(Scene::from_source(&source).unwrap());
        export(&source, &scene, state, &self.library(), Standard::Fmi2, &output).unwrap();
        self.read(name)
    }

    /// The files of a unit in the folder.
    fn read(&self, name: &str) -> BTreeMap<String, Vec<u8>> {
        let output = self.0.join(name);
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
fn the_default_experiment_ends_with_the_scene_in_the_steps_of_its_run() {
    let elements = description();
    let experiment = elements.iter().find(|element| element.name == "DefaultExperiment").unwrap();
    assert_eq!((experiment.get("startTime"), experiment.get("stopTime")), (Some("0.0"), Some("0.25")));
    assert_eq!(experiment.get("stepSize"), Some("0.0025"));
}

#[test]
fn lengths_and_angles_are_shown_in_units_that_are_defined() {
    let elements = description();
    let place = elements.iter().position(|it| it.get("name") == Some("floor.displacement.z")).unwrap();
    assert_eq!(elements[place + 1].get("displayUnit"), Some("mm"));
    let defined = below(&elements, "UnitDefinitions", "DisplayUnit");
    assert_eq!(
        defined.iter().map(|it| (it.get("name"), it.get("factor"))).collect::<Vec<_>>(),
        [(Some("mm"), Some("1000.0"))]
    );
}

#[test]
fn usual_magnitudes_follow_from_the_particles_and_their_weight() {
    let elements = description();
    let nominal = |name: &str| -> f64 {
        let place = elements.iter().position(|it| it.get("name") == Some(name)).unwrap();
        elements[place + 1].get("nominal").unwrap().parse().unwrap()
    };
    // Two spheres of glass with a radius of 10 mm.
    let weight = 2.0 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6 * 9.81;
    let digits = |value: f64| format!("{value:.2e}").parse::<f64>().unwrap();
    assert_eq!(nominal("floor.force.z"), digits(weight));
    assert_eq!(nominal("floor.displacement.z"), 0.01);
    assert_eq!(nominal("floor.work"), digits(0.01 * weight));
    assert_eq!(elements.iter().find(|it| it.name == "Integer").and_then(|it| it.get("nominal")), None);
}

#[test]
fn what_the_scene_says_of_itself_stands_in_the_description_the_page_and_the_licence() {
    let said = "[about]\ndescription = \"Two marbles & a floor\"\nauthor = \"Ada\"\nversion = \"2.1\"\nlicense = \"CC-BY-4.0\"\n";
    let source = Source { text: format!("{SCENE}\n{said}"), ..source() };
    let scene = Arc::new(Scene::from_source(&source).unwrap());
    let folder = Folder::new();
    export(&source, &scene, None, &folder.library(), Standard::Fmi2, &folder.0.join("unit.fmu")).unwrap();
    let unit = folder.read("unit.fmu");
    let description = elements(&unit["modelDescription.xml"]);
    for (name, text) in
        [("description", "Two marbles & a floor"), ("author", "Ada"), ("version", "2.1"), ("license", "CC-BY-4.0")]
    {
        assert_eq!(description[0].get(name), Some(text));
    }
    let page = String::from_utf8_lossy(&unit["documentation/index.html"]);
    assert!(page.contains("<p>Two marbles &amp; a floor.</p>") && page.contains("<td>Ada</td>"), "{page}");
    assert!(unit["documentation/licenses/license.txt"].starts_with(b"The model in resources/: licence CC-BY-4.0."));
}

#[test]
fn a_unit_has_a_library_for_each_platform_a_picture_a_page_and_licences() {
    let (source, folder) = (source(), Folder::new());
    let scene = Arc::new(Scene::from_source(&source).unwrap());
    let samples = [sample_library::Sample::WINDOWS, sample_library::Sample::MACOS, sample_library::Sample::LINUX];
    let paths = ["w", "m", "l"].map(|name| folder.0.join(name));
    for (sample, path) in samples.iter().zip(&paths) {
        fs::write(path, sample.bytes()).unwrap();
    }
    let libraries = Libraries { paths: paths.to_vec(), platforms: Vec::new() };
    export(&source, &scene, None, &libraries, Standard::Fmi2, &folder.0.join("two.fmu")).unwrap();
    let unit = folder.read("two.fmu");
    let binaries: Vec<&str> = unit.keys().map(String::as_str).filter(|path| path.starts_with("binaries")).collect();
    assert_eq!(binaries, ["binaries/darwin64/two.dylib", "binaries/linux64/two.so", "binaries/win64/two.dll"]);
    assert_eq!(unit["binaries/win64/two.dll"], samples[0].bytes());
    assert!(unit["model.png"].starts_with(b"\x89PNG"));
    let page = String::from_utf8_lossy(&unit["documentation/index.html"]);
    assert!(page.contains("darwin64, linux64, win64"), "{page}");
    let notices = String::from_utf8_lossy(&unit["documentation/licenses/third_party.txt"]);
    assert!(notices.contains("\nnalgebra "), "the notices name what is inside");
}

#[test]
fn the_page_says_bounds_in_words_and_components_in_one_row() {
    let unit = Folder::new().exported("unit.fmu", None);
    let page = String::from_utf8_lossy(&unit["documentation/index.html"]).into_owned();
    let row = |name: &str| {
        let start = page.find(&format!("<tr><td><code>{name}</code>")).unwrap_or_else(|| panic!("no row of {name}"));
        page[start..].lines().next().unwrap().to_owned()
    };
    assert_eq!(
        row("floor.force.x"),
        "<tr><td><code>floor.force.x</code>, <code>.y</code>, <code>.z</code></td><td>N</td><td>force of the particles on floor along \
         x, y, z</td></tr>"
    );
    let driven = row("floor.displacement.x");
    assert!(
        driven.contains("</code>, <code>.z</code></td><td>m</td><td>0</td><td>displacement of floor along x, z since"),
        "{driven}"
    );
    assert!(row("floor.work").contains("</code></td><td>J</td>"), "a quantity without components has a row of its own");
    assert!(row("run.time_step").contains("<td>s</td><td>1e-5</td><td>time step; 0: automatic; at least 0</td>"));
    assert!(row("run.safety").contains("; at least 0, below 1</td>"), "{}", row("run.safety"));
    assert!(row("run.accuracy").contains("; above 0, below 1</td>"), "{}", row("run.accuracy"));
    let modulus = row("material.glass.youngs_modulus");
    assert!(
        modulus.contains("<td>5e7</td><td>Young&apos;s modulus") && modulus.contains("; above 0</td>"),
        "{modulus}"
    );
    assert!(row("material.glass.poissons_ratio").contains("; at least 0, at most 0.5</td>"));
    assert!(row("pair.glass.glass.restitution").contains("; above 0, at most 1; tunable</td>"));
    assert!(page.contains("<a href=\"fmi-ls-ref.txt\">") && unit.contains_key("documentation/fmi-ls-ref.txt"));
}

#[test]
fn the_reference_experiment_is_what_the_scene_does() {
    let unit = Folder::new().exported("unit.fmu", None);
    let table = |name: &str| -> Vec<Vec<String>> {
        let text = String::from_utf8_lossy(&unit[&format!("extra/org.fmi-standard.fmi-ls-ref/{name}")]).into_owned();
        text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
    };
    let (inputs, results) = (table("inputs.csv"), table("results.csv"));
    assert_eq!(inputs[0], ["time", "floor.displacement.x", "floor.displacement.z"]);
    assert_eq!([inputs.len(), results.len()], [12, 12], "a heading and eleven communication points");
    let mut simulation =
        crate::engine::simulation::Simulation::new(Arc::new(Scene::from_source(&source()).unwrap())).unwrap();
    let column = results[0].iter().position(|name| name == "energy.kinetic").unwrap();
    for (point, row) in results[1..].iter().enumerate() {
        if point > 0 {
            simulation.advance(100.0 * 1.0e-5).unwrap();
        }
        let interface = Interface::of(simulation.scene());
        let kinetic = interface.value(&simulation, interface.find("energy.kinetic").unwrap());
        assert_eq!(row[column], kinetic.to_string(), "row {point}");
    }
    let manifest = elements(&unit["extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml"]);
    assert_eq!(below(&manifest, "fmiReferences", "Related").len(), 4);
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
    let scene = Arc::new(Scene::from_source(&source).unwrap());
    let missing = folder.0.join("missing/unit.fmu");
    let message = export(&source, &scene, None, &library, Standard::Fmi2, &missing).unwrap_err().to_string();
    assert!(message.contains("missing/unit.fmu"), "{message}");
    fs::create_dir(folder.0.join("taken.fmu")).unwrap();
    assert!(export(&source, &scene, None, &library, Standard::Fmi2, &folder.0.join("taken.fmu")).is_err());
    let left: Vec<_> = fs::read_dir(&*folder.0).unwrap().map(|entry| entry.unwrap().file_name()).collect();
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

#[test]
fn a_unit_of_fmi_3_has_arrays_terminals_and_folders_of_its_own() {
    let (source, folder) = (source(), Folder::new());
    let scene = Arc::new(Scene::from_source(&source).unwrap());
    export(&source, &scene, None, &folder.library(), Standard::Fmi3, &folder.0.join("three.fmu")).unwrap();
    let unit = folder.read("three.fmu");
    assert!(unit.contains_key("binaries/x86_64-linux/three.so") && unit.contains_key("terminalsAndIcons/icon.png"));
    assert!(!unit.contains_key("model.png"), "that is the picture of FMI 2.0");
    let description = elements(&unit["modelDescription.xml"]);
    assert_eq!(description[0].get("instantiationToken"), Some(identity(&source, None).as_str()));
    let interface = Interface::of(&scene);
    let arrays = interface.arrays(&scene);
    let variables: Vec<_> = description.iter().filter(|it| it.get("causality").is_some()).collect();
    assert_eq!(variables.len(), arrays.len() + 1, "and the time");
    for (place, (variable, array)) in variables.iter().zip(&arrays).enumerate() {
        assert_eq!(
            (variable.get("name"), variable.get("valueReference")),
            (Some(&*array.name), Some(&*place.to_string()))
        );
    }
    assert_eq!(variables[arrays.len()].get("causality"), Some("independent"));
    let elements_in_all: usize = arrays.iter().map(crate::interface::Array::count).sum();
    assert_eq!(elements_in_all, interface.variables().len(), "every value stands in one array");
    let of = |name: &str| arrays.iter().find(|array| array.name == name).map(|array| array.dimensions.clone());
    assert_eq!(of("floor.force"), Some(vec![3]));
    assert_eq!(of("floor.displacement.z"), Some(vec![]), "y is not driven: the others stay single");
    let terminals = elements(&unit["terminalsAndIcons/terminalsAndIcons.xml"]);
    let names = |kind: &str| {
        let named = terminals.iter().filter(|it| it.name == kind);
        named.filter_map(|it| it.get("name").or(it.get("variableName"))).collect::<Vec<_>>()
    };
    assert_eq!(names("Terminal"), ["floor", "side", "grip"]);
    assert!(names("TerminalMemberVariable").contains(&"floor.displacement.z"));
}
