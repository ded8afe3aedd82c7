//! `apex import --msg`.

use crate::{
    TARGET, builds,
    common::{Folder, apex, lock, stderr},
};
use std::{
    collections::BTreeMap,
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap()
}

fn import(paths: &[&Path], more: &[&str]) -> Output {
    apex().args(["import", "--msg"]).args(paths).args(more).output().unwrap()
}

fn rust_of(path: &Path) -> String {
    let output = import(&[path], &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_common_messages_are_those_of_their_definitions() {
    let folder = root().join("apex-messages");
    let (now, file) = (rust_of(&folder.join("definitions")), folder.join("src/packages.rs"));
    if env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        fs::write(&file, &now).unwrap();
    }
    let written = fs::read_to_string(&file).unwrap();
    assert!(written == now, "`apex import --msg apex-messages/definitions -o apex-messages/src/packages.rs`");
}

/// Package with all that a definition can have, and types of other packages.
fn arm(folder: &Folder) -> PathBuf {
    let place = folder.0.join("arm_msgs");
    for (name, text) in [
        (
            "msg/Grip.msg",
            "# A comment with a word = and a \"quote\n\
             uint8 OPEN = 0x10   # hexadecimal\nint16 LOW=-3\nstring NAME=\"grip # 1\"\nbool IS_OLD=true\nfloat32 HALF=0.5\n\
             Header header\nstring<=8 label \"left\"\nfloat64[2] range [0.5, 1]\nint8[<=3] steps\nbyte type\n\
             geometry_msgs/Pose[] poses\nFinger finger\nFinger[2] pair\nstring[] names\nbool[] flags\nchar letter 65\n",
        ),
        ("msg/Finger.msg", "float32 force 1.5\n"),
        ("msg/Nothing.msg", "# nothing\n"),
        ("srv/Close.srv", "float32 force\n---\nbool done\nstring why\n"),
        ("action/Move.action", "Grip goal\n---\nuint32 count\n---\nfloat32 share\n"),
    ] {
        let file = place.join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, text).unwrap();
    }
    place
}

#[test]
fn messages_of_other_packages_compile_and_come_back() {
    let _guard = builds();
    let folder = Folder::new("import-msg");
    let package = arm(&folder);
    let crate_folder = folder.0.join("arm");
    fs::create_dir_all(crate_folder.join("src")).unwrap();
    let output = import(&[&package], &["-o", crate_folder.join("src/messages.rs").to_str().unwrap()]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    let manifest = format!(
        "[package]\nname = \"arm\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[workspace]\n[dependencies]\n\
         apex-messages = {{ path = {:?} }}\n",
        root().join("apex-messages")
    );
    fs::write(crate_folder.join("Cargo.toml"), manifest).unwrap();
    lock(&crate_folder);
    fs::write(crate_folder.join("src/main.rs"), PROGRAM).unwrap();
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let run = Command::new(cargo)
        .args(["run", "--quiet", "--offline"])
        .current_dir(&crate_folder)
        .env("CARGO_TARGET_DIR", TARGET)
        .env("RUSTFLAGS", "-D warnings")
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", stderr(&run));
}

/// Program with the messages of `arm_msgs`.
const PROGRAM: &str = r##"mod messages;

use apex_messages::{Action, Message, Service, cdr::{Order, Reader, Writer}};
use messages::{ALL, arm_msgs::*};

fn main() {
    let mut grip = Grip::default();
    assert_eq!((Grip::OPEN, Grip::LOW, Grip::NAME, Grip::IS_OLD, Grip::HALF), (16, -3, "grip # 1", true, 0.5));
    assert_eq!((&*grip.label, grip.range, grip.letter, grip.pair[1].force), ("left", [0.5, 1.0], 65, 1.5));
    grip.header.frame_id = "wrist".to_owned();
    grip.steps = vec![-1, 2];
    grip.r#type = 7;
    grip.poses.resize(3, Default::default());
    grip.names = vec!["a".to_owned(), String::new()];
    grip.flags = vec![true, false];
    for order in [Order::Little, Order::Big] {
        let mut bytes = vec![];
        grip.write(&mut Writer::in_order(order, &mut bytes));
        assert_eq!(Grip::read(&mut Reader::new(&bytes).unwrap()), Ok(grip.clone()));
    }
    grip.steps = vec![0; 4];
    let error = Grip::from_bytes(&grip.to_bytes()).unwrap_err();
    assert_eq!(error, "a list or a text of at most 3 has 4");
    assert_eq!(Nothing::from_bytes(&Nothing {}.to_bytes()), Ok(Nothing::default()));
    assert_eq!(<Close as Service>::Request::NAME, "arm_msgs/srv/Close_Request");
    assert_eq!(<<Move as Action>::SendGoal as Service>::Request::NAME, "arm_msgs/action/Move_SendGoal_Request");
    assert!(<Move as Action>::HASH.starts_with("RIHS01_") && <Move as Action>::Goal::default().goal.range == [0.5, 1.0]);
    assert!(ALL.iter().any(|known| known.name == "arm_msgs/msg/Grip" && known.hash == Grip::HASH));
    assert!(Grip::DEFINITION.contains("string NAME=\"grip # 1\"\n") && Grip::DEFINITION.contains("MSG: arm_msgs/Finger\n"));
}
"##;

#[test]
fn mistakes_in_definitions_are_said_with_their_place() {
    let folder = Folder::new("import-msg-wrong");
    for (name, text, message) in [
        ("A.msg", "int32 x\nint32", "A.msg:2: a field needs a type and a name: `int32`"),
        ("A.msg", "int32 x\nint32 x", "A.msg:2: two fields are named `x`"),
        ("A.msg", "int32 x 1.5", "`p/msg/A`: the default of `x` is `1.5`, which is not a value of its type"),
        ("A.msg", "uint8 X=256", "A.msg:1: `256` is not a value of type `uint8`"),
        (
            "A.msg",
            "other_msgs/B b",
            "`p/msg/A` has a field of an unknown type `other_msgs/msg/B`, which neither these files nor `apex-messages` \
             have: correct its name, or name the folder of `other_msgs`, too",
        ),
        ("A.msg", "float6 x", "unknown type `p/msg/float6`, which neither these files"),
        ("A.msg", "A a", "`p/msg/A` contains itself"),
        ("A.msg", "wstring a", "A.msg:1: the type `wstring` is not supported"),
        ("A.msg", "int32[x] a", "`x` in `int32[x]` is not a number"),
        ("A.msg", "int32[999999999999] a", "is an array of more than a million elements"),
        ("A.msg", "int32 a\n---\nint32 b", "A.msg:1: a `.msg` file has 1 parts with `---` between them, not 2"),
        ("A.srv", "int32 a", "A.srv:1: a `.srv` file has 2 parts"),
        ("A.msg", "int32 a-b", "A.msg:1: `a-b` is not a name of a field"),
        ("A B.msg", "int32 a", "`p/A B` is not a name of a type"),
    ] {
        let file = folder.0.join("p").join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, text).unwrap();
        let output = import(&[&file], &[]);
        let said = stderr(&output);
        assert!(
            output.status.code() == Some(1) && output.stdout.is_empty() && said.contains(message),
            "{text}: {said}"
        );
        fs::remove_file(file).unwrap();
    }
    let output = import(&[&folder.0], &[]);
    assert_eq!((output.status.code(), stderr(&output).contains("there is no `.msg`")), (Some(2), true));
    let said = stderr(&import(&[&folder.0.join("nowhere")], &[]));
    assert!(said.contains("nowhere`: No such file or directory"), "{said}");
}

/// Writes the definitions of all messages of a distribution, and prints their hashes.
const PYTHON: &str = "import sys
from pathlib import Path
from rosbags.typesys import Stores, get_typestore
store = get_typestore(getattr(Stores, sys.argv[2]))
def ty(description):
    kind, value = description
    if kind.name == 'BASE':
        return value[0] + (f'<={value[1]}' if value[1] else '')
    if kind.name == 'NAME':
        return value
    inner, count = value
    if kind.name == 'ARRAY':
        return f'{ty(inner)}[{count}]'
    return ty(inner) + (f'[<={count}]' if count else '[]')
for name, (constants, fields) in store.fielddefs.items():
    lines = [f'{kind} {constant}={value!r}' if kind == 'string' else f'{kind} {constant}={value}' for constant, kind, value in constants]
    lines += [f'{ty(of)} {field}' for field, of in fields if field != 'structure_needs_at_least_one_member']
    path = Path(sys.argv[1]) / (name + '.msg')
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text('\\n'.join(lines))
    # For ROS 2, `char` is `uint8`; here it is another type, in the hash too.
    text = store.generate_msgdef(name, ros_version=2)[0]
    print(name, store.hash_rihs01(name), int('\\nchar' in '\\n' + text))
";

#[test]
fn hashes_of_all_messages_of_five_distributions_are_those_of_rosbags() {
    let environment = Path::new(TARGET).with_file_name("python").join("bin/python3");
    let environments = [environment, root().join("target/python/bin/python3"), PathBuf::from("python3")];
    let has = |python: &&PathBuf| {
        Command::new(python).args(["-c", "import rosbags"]).output().is_ok_and(|output| output.status.success())
    };
    let Some(python) = environments.iter().find(has) else {
        println!("skipped: no Python has `rosbags`");
        return;
    };
    for store in ["ROS2_HUMBLE", "ROS2_IRON", "ROS2_JAZZY", "ROS2_KILTED", "ROS2_LYRICAL"] {
        let folder = Folder::new(&format!("import-{store}"));
        let output = Command::new(python).args(["-c", PYTHON]).arg(&folder.0).arg(store).output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        let rust = rust_of(&folder.0);
        let constants = |name: &str| {
            let begin = format!("const {name}: &'static str = \"");
            let parts = rust.split(&begin).skip(1).map(|part| part.split('"').next().unwrap().to_owned());
            parts.collect::<Vec<_>>()
        };
        let ours: BTreeMap<String, String> = constants("NAME").into_iter().zip(constants("HASH")).collect();
        let said = String::from_utf8(output.stdout).unwrap();
        let mut different = vec![];
        for line in said.lines() {
            let [name, hash, has_char] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
            if ours.get(name).map(String::as_str) != Some(hash) && has_char == "0" {
                different.push(name.to_owned());
            }
        }
        assert!(said.lines().count() > 100 && different.is_empty(), "{store}: {different:?}");
    }
}
