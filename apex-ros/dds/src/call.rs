//! Clients of services.

use crate::{
    Vendor,
    listen::{Listening, Sample},
    name,
    participant::{Participant, Writer},
    qos::policies,
    raw::Raw,
    serve::{NAME, join, split},
};
use apex_ros::{Ask, Endpoint, Error, HearResponse, Kind};
use rustdds::{GUID, SampleIdentity, Timestamp, WriteOptionsBuilder};
use std::{
    collections::HashMap,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicI64, Ordering},
    },
    time::{Duration, Instant},
};

/// Time that a server that is there has for the first exchange: a request before it would be lost.
const PATIENCE: Duration = Duration::from_secs(1);

/// Client of a service.
pub struct Client {
    participant: Arc<Participant>,
    /// Kind, name and type of a server.
    server: Endpoint,
    vendor: Vendor,
    writer: Writer,
    reader: GUID,
    waiting: Arc<Waiting>,
    number: AtomicI64,
    timeout: Duration,
    _listening: Listening,
}

/// Requests that wait for their responses.
#[derive(Default)]
struct Waiting(Mutex<HashMap<i64, (Instant, HearResponse)>>);

impl Client {
    pub fn open(
        participant: &Arc<Participant>,
        endpoint: &Endpoint,
        vendor: Vendor,
        timeout: Duration,
    ) -> Result<Self, Error> {
        let [requests, responses] = name::service(endpoint);
        let policies = policies(&endpoint.qos);
        let (writer, reader) = (participant.writer(&requests, &policies)?, participant.reader(&responses, &policies)?);
        let (waiting, id) = (Arc::new(Waiting::default()), reader.guid());
        let (hearing, looking, writer_id) = (Arc::clone(&waiting), Arc::clone(&waiting), guid(&writer));
        let hear = move |sample: Sample| hearing.hear(vendor, writer_id, sample);
        let listening = Listening::start(&endpoint.name, reader, hear, move || looking.forget())?;
        Ok(Self {
            participant: Arc::clone(participant),
            server: Endpoint { kind: Kind::Server, ..endpoint.clone() },
            vendor,
            writer,
            reader: id,
            waiting,
            number: AtomicI64::new(1),
            timeout,
            _listening: listening,
        })
    }

    /// Sends a request that is named by its number.
    fn send(&self, request: &[u8], number: i64) -> Result<(), String> {
        let message = Raw(join(within(guid(&self.writer), number), request));
        let options = WriteOptionsBuilder::new().source_timestamp(Timestamp::now()).build();
        self.writer.write_with_options(message, options).map(drop).map_err(|error| format!("DDS: {error}"))
    }
}

fn guid(writer: &Writer) -> GUID {
    rustdds::RTPSEntity::guid(writer)
}

/// Name of a request in messages of Cyclone DDS: the second half of its writer, and its number.
fn within(writer: GUID, number: i64) -> [u8; NAME] {
    let mut name = [0; NAME];
    name[..8].copy_from_slice(&writer.to_bytes()[8..]);
    name[8..].copy_from_slice(&number.to_le_bytes());
    name
}

impl Ask for Client {
    fn ask(&self, request: Vec<u8>, hear: HearResponse) -> Result<(), String> {
        if !self.participant.known.is_served(&self.server, guid(&self.writer), self.reader, PATIENCE) {
            // Without a server, `hear` is dropped.
            return Ok(());
        }
        let until = Instant::now() + self.timeout;
        match self.vendor {
            Vendor::Cyclone => {
                let number = self.number.fetch_add(1, Ordering::Relaxed);
                self.waiting.all().insert(number, (until, hear));
                self.send(&request, number)
            }
            Vendor::Fast => {
                // The response cannot be heard before its number is known.
                let mut waiting = self.waiting.all();
                let options = WriteOptionsBuilder::new().source_timestamp(Timestamp::now()).build();
                let sent = self.writer.write_with_options(Raw(request.into()), options);
                let SampleIdentity { sequence_number, .. } = sent.map_err(|error| format!("DDS: {error}"))?;
                waiting.insert(sequence_number.into(), (until, hear));
                Ok(())
            }
        }
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.participant.remove(guid(&self.writer));
        self.participant.remove(self.reader);
    }
}

impl Waiting {
    /// Passes a response on, if it is one to this client.
    fn hear(&self, vendor: Vendor, writer: GUID, sample: Sample) {
        let (number, response) = match vendor {
            Vendor::Fast => {
                let Some(request) = sample.related_sample_identity() else { return };
                if request.writer_guid != writer {
                    return;
                }
                (request.sequence_number.into(), sample.into_value())
            }
            Vendor::Cyclone => {
                let Some((name, response)) = split(&sample.into_value().0) else { return };
                let number = i64::from_le_bytes(std::array::from_fn(|i| name[8 + i]));
                if name != within(writer, number) {
                    return;
                }
                (number, Raw(response))
            }
        };
        let found = self.all().remove(&number);
        if let Some((_, hear)) = found {
            hear(Ok(response.into()));
        }
    }

    /// Forgets requests whose time is over.
    fn forget(&self) {
        let now = Instant::now();
        let mut late = vec![];
        let mut all = self.all();
        let over: Vec<i64> = all.iter().filter(|(_, (until, _))| *until <= now).map(|(number, _)| *number).collect();
        late.extend(over.iter().filter_map(|number| all.remove(number)));
        drop(all);
        for (_, hear) in late {
            hear(Err("the server has not answered".to_owned()));
        }
    }

    fn all(&self) -> MutexGuard<'_, HashMap<i64, (Instant, HearResponse)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
