use super::*;

fn tetrahedron() -> TriangleMesh {
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap()
}

fn model(shape: ExportShape) -> ObjectModel {
    let inertia = DMat3::from_cols_array(&[1.4, 0.08, -0.05, 0.08, 1.9, 0.06, -0.05, 0.06, 2.3]);
    ObjectModel {
        name: "object".to_owned(),
        notes: vec!["a -- b --- <c>".to_owned()],
        mass: MassProperties::new(1.3, inertia).unwrap(),
        deviations: Some(MassDeviations {
            mass: 0.01,
            inertia: DMat3::from_diagonal(DVec3::new(1e-3, 2e-3, 3e-3)),
        }),
        shape,
        seen: vec![("inner".to_owned(), tetrahedron())],
        start: None,
    }
}

fn ellipsoid() -> ExportShape {
    let orientation = DQuat::from_rotation_z(0.3);
    ExportShape::Ellipsoid {
        centre: DVec3::new(0.1, 0.0, 0.0),
        orientation,
        semi_axes: DVec3::new(1.0, 2.0, 2.5),
    }
}

fn text<'a>(files: &'a [ExportedFile], name: &str) -> &'a str {
    let file = files.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("{name} is missing"));
    std::str::from_utf8(&file.contents).unwrap()
}

#[test]
fn files_name_each_other_and_hold_every_digit() {
    let files = model(ellipsoid()).files(&[ExportFormat::Mjcf, ExportFormat::Urdf]).unwrap();
    let names: Vec<_> = files.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names, ["object.xml", "object.urdf", "object_inner.obj", "object_ellipsoid.obj"]);
    let mjcf = text(&files, "object.xml");
    assert!(mjcf.contains(r#"mass="1.3" fullinertia="1.4 1.9 2.3 0.08 -0.05 0.06""#), "{mjcf}");
    assert!(mjcf.contains(r#"file="object_inner.obj""#) && !mjcf.contains("object_ellipsoid.obj"));
    assert!(mjcf.contains(r#"name="object_inertia_std" data="0.001 0.002 0.003 0.0 0.0 0.0""#), "{mjcf}");
    let urdf = text(&files, "object.urdf");
    let tensor = r#"ixx="1.4" ixy="0.08" ixz="-0.05" iyy="1.9" iyz="0.06" izz="2.3""#;
    assert!(urdf.contains(tensor) && urdf.contains(r#"filename="object_ellipsoid.obj""#), "{urdf}");
    for file in [mjcf, urdf] {
        assert!(file.contains("<!-- a - - b - - - <c> -->"), "{file}");
    }
    assert!(text(&files, "object_inner.obj").starts_with("v 0.0 0.0 0.0\nv 1.0 0.0 0.0\n"));
    assert!(model(ellipsoid()).files(&[]).unwrap().is_empty());
}

#[test]
fn a_shape_that_is_also_seen_is_written_once() {
    let shape = ExportShape::Mesh { name: "inner".to_owned(), mesh: tetrahedron() };
    let files = model(shape).files(&[ExportFormat::Mjcf]).unwrap();
    assert_eq!(files.len(), 2);
    assert_eq!(text(&files, "object.xml").matches("<mesh ").count(), 1);
}

#[test]
fn the_mesh_of_an_ellipsoid_is_closed_and_near_it() {
    let semi_axes = DVec3::new(1.0, 2.0, 2.5);
    let mesh = surface::ellipsoid(DVec3::ZERO, DQuat::IDENTITY, semi_axes);
    surface::check("ellipsoid", &mesh).unwrap();
    let solid = recon::shape_bounds::exact_hull::TriangleMesh {
        vertices: mesh.vertices.clone(),
        triangles: mesh.triangles.clone(),
    };
    let missing =
        1.0 - solid.moments().volume / (4.0 / 3.0 * std::f64::consts::PI * semi_axes.element_product());
    assert!(missing > 0.0 && missing < 5e-3, "{missing}");
    // The middle of a facet is inside by at most 1 - cos(2.65 degrees), the angle being half its longest edge.
    for t in &mesh.triangles {
        let middle = t.iter().map(|&v| mesh.vertices[v as usize] / semi_axes).sum::<DVec3>() / 3.0;
        assert!(middle.length() >= 0.998_93, "{middle}");
    }
}

#[test]
fn models_that_cannot_be_are_refused() {
    let refused = |change: &dyn Fn(&mut ObjectModel)| {
        let mut model = model(ellipsoid());
        change(&mut model);
        model.files(&[ExportFormat::Mjcf]).unwrap_err()
    };
    let name = refused(&|m| m.name = "a/b".to_owned());
    assert_eq!(name, ExportError::Name { name: "a/b".to_owned() });
    let flat = ExportShape::Ellipsoid {
        centre: DVec3::ZERO,
        orientation: DQuat::IDENTITY,
        semi_axes: DVec3::new(1.0, 0.0, 1.0),
    };
    assert_eq!(refused(&|m| m.shape = flat.clone()), ExportError::SemiAxis { value: 0.0 });
    let open = refused(&|m| m.seen[0].1.triangles.truncate(3));
    assert_eq!(open, ExportError::Open { name: "inner".to_owned(), open: 3 });
    let empty = refused(&|m| m.seen[0].1 = TriangleMesh::default());
    assert_eq!(empty, ExportError::Empty { name: "inner".to_owned() });
}
