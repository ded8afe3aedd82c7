//! Reader of a database of rosbag2 (SQLite), the format of ROS 2 before MCAP. Messages are in the order of their times,
//! as `ros2 bag play` has them.

use crate::{Channel, Message, format::MESSAGES, packed::LARGEST};
use rusqlite::{Connection, Error, OpenFlags, Row, limits::Limit};
use std::{
    collections::{BTreeMap, HashMap},
    io,
    path::Path,
    vec,
};

/// First bytes of a database.
pub const MAGIC: &[u8] = b"SQLite format 3\0";

/// Settings for files of others, which may be damaged. With the last one, which changes nothing in a file that is only
/// read, a file that is shorter than its head says is read up to there.
const CAREFUL: &str = "PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA query_only = ON; \
    PRAGMA writable_schema = ON";

/// Database that is being read.
pub struct Sqlite {
    database: Connection,
    /// Numbers of the messages that are not read yet, with their times.
    left: vec::IntoIter<(u64, i64)>,
    /// Number of the channel of each topic.
    numbers: HashMap<i64, u16>,
    /// Channels by their number.
    pub channels: BTreeMap<u16, Channel>,
    /// Reason why the database could not be read to its end.
    pub cut: Option<String>,
}

impl Sqlite {
    /// Opens a database.
    ///
    /// # Errors
    /// The file cannot be read, or is not a database of rosbag2.
    pub fn open(path: &Path) -> io::Result<Self> {
        let opened = |database: &Connection| {
            database.execute_batch(CAREFUL)?;
            database.set_limit(Limit::SQLITE_LIMIT_LENGTH, i32::try_from(LARGEST).unwrap_or(i32::MAX))?;
            channels(database)
        };
        let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
        let database = Connection::open_with_flags(path, flags).map_err(|error| refusal(path, &error))?;
        let (numbers, channels) = opened(&database).map_err(|error| refusal(path, &error))?;
        let (mut left, cut) = times(&database);
        left.sort_unstable();
        Ok(Self { database, left: left.into_iter(), numbers, channels, cut })
    }

    /// Returns the next message; `None` at the end, or where the database is damaged.
    pub fn next_message(&mut self) -> Option<Message> {
        let (time, id) = self.left.next()?;
        match self.message(time, id) {
            Ok(message) => Some(message),
            Err(why) => {
                self.left = vec![].into_iter();
                self.cut.get_or_insert(why);
                None
            }
        }
    }

    fn message(&self, time: u64, id: i64) -> Result<Message, String> {
        let select = self.database.prepare_cached("SELECT topic_id, data FROM messages WHERE id = ?1");
        let read = |row: &Row<'_>| Ok((row.get(0)?, row.get(1)?));
        let found: Result<(i64, Vec<u8>), _> = select.and_then(|mut select| select.query_row([id], read));
        let (topic, data) = found.map_err(|error| damage(&error))?;
        let channel = *self.numbers.get(&topic).ok_or_else(|| {
            format!("it is damaged: message {id} belongs to topic {topic}, which is not in the table `topics`")
        })?;
        Ok(Message { channel, time, sequence: 0, data })
    }
}

/// Reason why a file is not read.
fn refusal(path: &Path, error: &Error) -> io::Error {
    let journal = |ending: &str| {
        let mut name = path.as_os_str().to_owned();
        name.push(ending);
        Path::new(&name).exists()
    };
    let why = if journal("-journal") || journal("-wal") {
        "its recorder did not close it, and a journal lies beside it: `sqlite3 FILE .tables`, in a folder that can be \
         written, completes it"
    } else {
        "it is not a database of rosbag2, or it is damaged"
    };
    io::Error::new(io::ErrorKind::InvalidData, format!("{why} (SQLite: {error})"))
}

fn damage(error: &Error) -> String {
    format!("it is damaged: {error}")
}

/// Number of the channel of each topic, and the channels by their number.
type Channels = (HashMap<i64, u16>, BTreeMap<u16, Channel>);

/// The channels of all topics.
fn channels(database: &Connection) -> Result<Channels, Error> {
    let shapes = shapes(database)?;
    let mut select = database.prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id")?;
    let channel = |row: &Row<'_>| {
        let (topic, schema): (String, String) = (row.get(1)?, row.get(2)?);
        let shape = shapes.get(&schema).cloned();
        Ok((row.get(0)?, Channel { name: topic.clone(), topic, schema, shape, encoding: row.get(3)? }))
    };
    let (mut numbers, mut channels) = (HashMap::new(), BTreeMap::new());
    // More topics than there are numbers are those of a damaged file.
    for (number, found) in (0..u16::MAX).zip(select.query_map([], channel)?) {
        let (id, channel) = found?;
        numbers.insert(id, number);
        channels.insert(number, channel);
    }
    Ok((numbers, channels))
}

/// Definitions of the messages by their types; those before Iron have none.
fn shapes(database: &Connection) -> Result<HashMap<String, String>, Error> {
    if !database.table_exists(None, "message_definitions")? {
        return Ok(HashMap::new());
    }
    let mut select = database.prepare(
        "SELECT topic_type, encoded_message_definition FROM message_definitions \
         WHERE encoding = ?1 AND encoded_message_definition != ''",
    )?;
    select.query_map([MESSAGES], |row| Ok((row.get(0)?, row.get(1)?)))?.collect()
}

/// Times and numbers of the messages: those that can be read, and the reason why there are no more. The table is read
/// without its index, of which a damaged file has less.
fn times(database: &Connection) -> (Vec<(u64, i64)>, Option<String>) {
    let mut times = vec![];
    let mut read = || -> Result<(), String> {
        let select = database.prepare("SELECT timestamp, id FROM messages NOT INDEXED ORDER BY id");
        let mut select = select.map_err(|error| damage(&error))?;
        let rows = select.query_map([], |row| Ok((row.get::<_, i64>(0)?, row.get(1)?)));
        for row in rows.map_err(|error| damage(&error))? {
            let (time, id) = row.map_err(|error| damage(&error))?;
            let time =
                u64::try_from(time).map_err(|_| format!("it is damaged: message {id} has the time {time} ns"))?;
            times.push((time, id));
        }
        Ok(())
    };
    let cut = read().err();
    (times, cut)
}
