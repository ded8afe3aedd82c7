//! Names of topics and types in DDS: `rt/scan` for the topic `/scan`, `rq/flipRequest` and `rr/flipReply` for the
//! service `/flip`.

use apex_ros::{Endpoint, Kind};

/// Name and type of a topic of DDS.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topic {
    /// Name: `rt/scan`.
    pub name: String,
    /// Type: `sensor_msgs::msg::dds_::LaserScan_`.
    pub ty: String,
}

/// Topic of a publisher or subscription.
pub fn data(endpoint: &Endpoint) -> Topic {
    Topic { name: format!("rt{}", endpoint.name), ty: endpoint.wire_type.clone() }
}

/// Topics of the requests and the responses of a service.
pub fn service(endpoint: &Endpoint) -> [Topic; 2] {
    let ty = |part: &str| format!("{}{part}_", endpoint.wire_type);
    let name = &endpoint.name;
    [
        Topic { name: format!("rq{name}Request"), ty: ty("Request") },
        Topic { name: format!("rr{name}Reply"), ty: ty("Response") },
    ]
}

/// Kind, name and type of an endpoint of ROS, by a reader or writer of a topic of DDS. A service is known by its
/// requests.
pub fn endpoint(topic: &str, ty: &str, is_writer: bool) -> Option<(Kind, String, String)> {
    if let Some(name) = topic.strip_prefix("rt/") {
        let kind = if is_writer { Kind::Publisher } else { Kind::Subscription };
        return Some((kind, format!("/{name}"), ty.to_owned()));
    }
    let name = topic.strip_prefix("rq/")?.strip_suffix("Request")?;
    let kind = if is_writer { Kind::Client } else { Kind::Server };
    Some((kind, format!("/{name}"), ty.strip_suffix("Request_")?.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_ros::{NO_HASH, Qos, wire_type};

    #[test]
    fn names_come_back() {
        let of = |kind, name: &str, ty: &str| Endpoint {
            kind,
            name: name.to_owned(),
            wire_type: wire_type(ty),
            hash: NO_HASH.to_owned(),
            qos: Qos::DEFAULT,
        };
        let scan = of(Kind::Publisher, "/robot1/scan", "sensor_msgs/msg/LaserScan");
        let topic = data(&scan);
        assert_eq!((&*topic.name, &*topic.ty), ("rt/robot1/scan", "sensor_msgs::msg::dds_::LaserScan_"));
        let back = endpoint(&topic.name, &topic.ty, true);
        assert_eq!(back, Some((Kind::Publisher, scan.name, scan.wire_type)));
        let flip = of(Kind::Server, "/flip", "std_srvs/srv/SetBool");
        let [request, response] = service(&flip);
        assert_eq!((&*request.name, &*request.ty), ("rq/flipRequest", "std_srvs::srv::dds_::SetBool_Request_"));
        assert_eq!((&*response.name, &*response.ty), ("rr/flipReply", "std_srvs::srv::dds_::SetBool_Response_"));
        assert_eq!(endpoint(&request.name, &request.ty, false), Some((Kind::Server, flip.name, flip.wire_type)));
        for (name, ty) in [("rr/flipReply", "x"), ("scan", "x"), ("rq/flip", "x"), ("rq/flipRequest", "x")] {
            assert_eq!(endpoint(name, ty, true), None, "{name}");
        }
    }
}
