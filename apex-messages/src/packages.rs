//! Messages of ROS 2, written by `apex import --msg`. Write them again instead of changing them.
extern crate alloc;
use ::apex_messages::{Action, Known, Message, Reason, Service, cdr::{Reader, Writer}};
/// Package `action_msgs`.
pub mod action_msgs {
    use super::*;
    /// `action_msgs/msg/GoalInfo`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GoalInfo {
        pub goal_id: super::unique_identifier_msgs::UUID,
        pub stamp: super::builtin_interfaces::Time,
    }
    impl Default for GoalInfo {
        #[inline]
        fn default() -> Self {
            Self {
                goal_id: Default::default(),
                stamp: Default::default(),
            }
        }
    }
    impl Message for GoalInfo {
        const NAME: &'static str = "action_msgs/msg/GoalInfo";
        const DEFINITION: &'static str = "unique_identifier_msgs/UUID goal_id\nbuiltin_interfaces/Time stamp\n================================================================================\nMSG: unique_identifier_msgs/UUID\nuint8[16] uuid\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_6398fe763154554353930716b225947f93b672f0fb2e49fdd01bb7a7e37933e9";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.goal_id, to);
            Message::write(&self.stamp, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                goal_id: Message::read(from)?,
                stamp: Message::read(from)?,
            })
        }
    }
    /// `action_msgs/msg/GoalStatus`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GoalStatus {
        pub goal_info: super::action_msgs::GoalInfo,
        pub status: i8,
    }
    impl GoalStatus {
        pub const STATUS_UNKNOWN: i8 = 0;
        pub const STATUS_ACCEPTED: i8 = 1;
        pub const STATUS_EXECUTING: i8 = 2;
        pub const STATUS_CANCELING: i8 = 3;
        pub const STATUS_SUCCEEDED: i8 = 4;
        pub const STATUS_CANCELED: i8 = 5;
        pub const STATUS_ABORTED: i8 = 6;
    }
    impl Default for GoalStatus {
        #[inline]
        fn default() -> Self {
            Self {
                goal_info: Default::default(),
                status: Default::default(),
            }
        }
    }
    impl Message for GoalStatus {
        const NAME: &'static str = "action_msgs/msg/GoalStatus";
        const DEFINITION: &'static str = "int8 STATUS_UNKNOWN=0\nint8 STATUS_ACCEPTED=1\nint8 STATUS_EXECUTING=2\nint8 STATUS_CANCELING=3\nint8 STATUS_SUCCEEDED=4\nint8 STATUS_CANCELED=5\nint8 STATUS_ABORTED=6\naction_msgs/GoalInfo goal_info\nint8 status\n================================================================================\nMSG: action_msgs/GoalInfo\nunique_identifier_msgs/UUID goal_id\nbuiltin_interfaces/Time stamp\n================================================================================\nMSG: unique_identifier_msgs/UUID\nuint8[16] uuid\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_32f4cfd717735d17657e1178f24431c1ce996c878c515230f6c5b3476819dbb9";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.goal_info, to);
            to.number(self.status);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                goal_info: Message::read(from)?,
                status: from.number()?,
            })
        }
    }
    /// `action_msgs/msg/GoalStatusArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GoalStatusArray {
        pub status_list: alloc::vec::Vec<super::action_msgs::GoalStatus>,
    }
    impl Default for GoalStatusArray {
        #[inline]
        fn default() -> Self {
            Self {
                status_list: Default::default(),
            }
        }
    }
    impl Message for GoalStatusArray {
        const NAME: &'static str = "action_msgs/msg/GoalStatusArray";
        const DEFINITION: &'static str = "action_msgs/GoalStatus[] status_list\n================================================================================\nMSG: action_msgs/GoalStatus\nint8 STATUS_UNKNOWN=0\nint8 STATUS_ACCEPTED=1\nint8 STATUS_EXECUTING=2\nint8 STATUS_CANCELING=3\nint8 STATUS_SUCCEEDED=4\nint8 STATUS_CANCELED=5\nint8 STATUS_ABORTED=6\naction_msgs/GoalInfo goal_info\nint8 status\n================================================================================\nMSG: action_msgs/GoalInfo\nunique_identifier_msgs/UUID goal_id\nbuiltin_interfaces/Time stamp\n================================================================================\nMSG: unique_identifier_msgs/UUID\nuint8[16] uuid\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.status_list.len());
            for element in &self.status_list {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                status_list: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `action_msgs/srv/CancelGoal`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct CancelGoal;
    impl Service for CancelGoal {
        const NAME: &'static str = "action_msgs/srv/CancelGoal";
        const HASH: &'static str = "RIHS01_573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a";
        type Request = super::action_msgs::CancelGoalRequest;
        type Response = super::action_msgs::CancelGoalResponse;
    }
    /// `action_msgs/srv/CancelGoal_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct CancelGoalRequest {
        pub goal_info: super::action_msgs::GoalInfo,
    }
    impl Default for CancelGoalRequest {
        #[inline]
        fn default() -> Self {
            Self {
                goal_info: Default::default(),
            }
        }
    }
    impl Message for CancelGoalRequest {
        const NAME: &'static str = "action_msgs/srv/CancelGoal_Request";
        const DEFINITION: &'static str = "action_msgs/GoalInfo goal_info\n================================================================================\nMSG: action_msgs/GoalInfo\nunique_identifier_msgs/UUID goal_id\nbuiltin_interfaces/Time stamp\n================================================================================\nMSG: unique_identifier_msgs/UUID\nuint8[16] uuid\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_3d3c84653c1f96918086887e1dcb236faec88b81a5b14fd4cf4840065bcdf8af";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.goal_info, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                goal_info: Message::read(from)?,
            })
        }
    }
    /// `action_msgs/srv/CancelGoal_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct CancelGoalResponse {
        pub return_code: i8,
        pub goals_canceling: alloc::vec::Vec<super::action_msgs::GoalInfo>,
    }
    impl CancelGoalResponse {
        pub const ERROR_NONE: i8 = 0;
        pub const ERROR_REJECTED: i8 = 1;
        pub const ERROR_UNKNOWN_GOAL_ID: i8 = 2;
        pub const ERROR_GOAL_TERMINATED: i8 = 3;
    }
    impl Default for CancelGoalResponse {
        #[inline]
        fn default() -> Self {
            Self {
                return_code: Default::default(),
                goals_canceling: Default::default(),
            }
        }
    }
    impl Message for CancelGoalResponse {
        const NAME: &'static str = "action_msgs/srv/CancelGoal_Response";
        const DEFINITION: &'static str = "int8 ERROR_NONE=0\nint8 ERROR_REJECTED=1\nint8 ERROR_UNKNOWN_GOAL_ID=2\nint8 ERROR_GOAL_TERMINATED=3\nint8 return_code\naction_msgs/GoalInfo[] goals_canceling\n================================================================================\nMSG: action_msgs/GoalInfo\nunique_identifier_msgs/UUID goal_id\nbuiltin_interfaces/Time stamp\n================================================================================\nMSG: unique_identifier_msgs/UUID\nuint8[16] uuid\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_35e682cf3f510e83c70a82a4aac888496dedee56773bf9d8e5e0aa81f9e1c960";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.return_code);
            to.length(self.goals_canceling.len());
            for element in &self.goals_canceling {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                return_code: from.number()?,
                goals_canceling: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
}
/// Package `builtin_interfaces`.
pub mod builtin_interfaces {
    use super::*;
    /// `builtin_interfaces/msg/Duration`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Duration {
        pub sec: i32,
        pub nanosec: u32,
    }
    impl Default for Duration {
        #[inline]
        fn default() -> Self {
            Self {
                sec: Default::default(),
                nanosec: Default::default(),
            }
        }
    }
    impl Message for Duration {
        const NAME: &'static str = "builtin_interfaces/msg/Duration";
        const DEFINITION: &'static str = "int32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_e8d009f659816f758b75334ee1a9ca5b5c0b859843261f14c7f937349599d93b";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.sec);
            to.number(self.nanosec);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                sec: from.number()?,
                nanosec: from.number()?,
            })
        }
    }
    /// `builtin_interfaces/msg/Time`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Time {
        pub sec: i32,
        pub nanosec: u32,
    }
    impl Default for Time {
        #[inline]
        fn default() -> Self {
            Self {
                sec: Default::default(),
                nanosec: Default::default(),
            }
        }
    }
    impl Message for Time {
        const NAME: &'static str = "builtin_interfaces/msg/Time";
        const DEFINITION: &'static str = "int32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.sec);
            to.number(self.nanosec);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                sec: from.number()?,
                nanosec: from.number()?,
            })
        }
    }
}
/// Package `diagnostic_msgs`.
pub mod diagnostic_msgs {
    use super::*;
    /// `diagnostic_msgs/msg/DiagnosticArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct DiagnosticArray {
        pub header: super::std_msgs::Header,
        pub status: alloc::vec::Vec<super::diagnostic_msgs::DiagnosticStatus>,
    }
    impl Default for DiagnosticArray {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                status: Default::default(),
            }
        }
    }
    impl Message for DiagnosticArray {
        const NAME: &'static str = "diagnostic_msgs/msg/DiagnosticArray";
        const DEFINITION: &'static str = "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: diagnostic_msgs/DiagnosticStatus\nbyte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\nstring message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n================================================================================\nMSG: diagnostic_msgs/KeyValue\nstring key\nstring value";
        const HASH: &'static str = "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.status.len());
            for element in &self.status {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                status: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `diagnostic_msgs/msg/DiagnosticStatus`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct DiagnosticStatus {
        pub level: u8,
        pub name: alloc::string::String,
        pub message: alloc::string::String,
        pub hardware_id: alloc::string::String,
        pub values: alloc::vec::Vec<super::diagnostic_msgs::KeyValue>,
    }
    impl DiagnosticStatus {
        pub const OK: u8 = 0;
        pub const WARN: u8 = 1;
        pub const ERROR: u8 = 2;
        pub const STALE: u8 = 3;
    }
    impl Default for DiagnosticStatus {
        #[inline]
        fn default() -> Self {
            Self {
                level: Default::default(),
                name: Default::default(),
                message: Default::default(),
                hardware_id: Default::default(),
                values: Default::default(),
            }
        }
    }
    impl Message for DiagnosticStatus {
        const NAME: &'static str = "diagnostic_msgs/msg/DiagnosticStatus";
        const DEFINITION: &'static str = "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\nstring message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n================================================================================\nMSG: diagnostic_msgs/KeyValue\nstring key\nstring value";
        const HASH: &'static str = "RIHS01_b0e3e692ea2d54a8af2f4ef1930e81556a2db55216b771f8a7d2724ed47bf0e4";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.level);
            to.text(&self.name);
            to.text(&self.message);
            to.text(&self.hardware_id);
            to.length(self.values.len());
            for element in &self.values {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                level: from.number()?,
                name: from.text_of(usize::MAX)?,
                message: from.text_of(usize::MAX)?,
                hardware_id: from.text_of(usize::MAX)?,
                values: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `diagnostic_msgs/msg/KeyValue`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct KeyValue {
        pub key: alloc::string::String,
        pub value: alloc::string::String,
    }
    impl Default for KeyValue {
        #[inline]
        fn default() -> Self {
            Self {
                key: Default::default(),
                value: Default::default(),
            }
        }
    }
    impl Message for KeyValue {
        const NAME: &'static str = "diagnostic_msgs/msg/KeyValue";
        const DEFINITION: &'static str = "string key\nstring value";
        const HASH: &'static str = "RIHS01_d68081eaa540288c5440753baecef0c4e16e81a5f78ad68902ded5100413bb42";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.key);
            to.text(&self.value);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                key: from.text_of(usize::MAX)?,
                value: from.text_of(usize::MAX)?,
            })
        }
    }
}
/// Package `example_interfaces`.
pub mod example_interfaces {
    use super::*;
    /// `example_interfaces/action/Fibonacci`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct Fibonacci;
    impl Action for Fibonacci {
        const NAME: &'static str = "example_interfaces/action/Fibonacci";
        const HASH: &'static str = "RIHS01_9508051da1ea4658de144b09bd0690ff3de52104683d847aed764d2915906f51";
        type Goal = super::example_interfaces::FibonacciGoal;
        type Result = super::example_interfaces::FibonacciResult;
        type Feedback = super::example_interfaces::FibonacciFeedback;
        type SendGoal = super::example_interfaces::FibonacciSendGoal;
        type GetResult = super::example_interfaces::FibonacciGetResult;
        type FeedbackMessage = super::example_interfaces::FibonacciFeedbackMessage;
    }
    /// `example_interfaces/action/Fibonacci_Feedback`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FibonacciFeedback {
        pub sequence: alloc::vec::Vec<i32>,
    }
    impl Default for FibonacciFeedback {
        #[inline]
        fn default() -> Self {
            Self {
                sequence: Default::default(),
            }
        }
    }
    impl Message for FibonacciFeedback {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_Feedback";
        const DEFINITION: &'static str = "int32[] sequence";
        const HASH: &'static str = "RIHS01_2b12e37361da6f408d4c85bc24a18de64333f29082f2ca34b5ee33dc4c8b42a9";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.sequence.len());
            to.numbers(&self.sequence);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                sequence: from.list(usize::MAX)?,
            })
        }
    }
    /// `example_interfaces/action/Fibonacci_FeedbackMessage`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FibonacciFeedbackMessage {
        pub goal_id: super::unique_identifier_msgs::UUID,
        pub feedback: super::example_interfaces::FibonacciFeedback,
    }
    impl Default for FibonacciFeedbackMessage {
        #[inline]
        fn default() -> Self {
            Self {
                goal_id: Default::default(),
                feedback: Default::default(),
            }
        }
    }
    impl Message for FibonacciFeedbackMessage {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_FeedbackMessage";
        const DEFINITION: &'static str = "unique_identifier_msgs/UUID goal_id\nexample_interfaces/action/Fibonacci_Feedback feedback\n================================================================================\nMSG: unique_identifier_msgs/UUID\nuint8[16] uuid\n================================================================================\nMSG: example_interfaces/action/Fibonacci_Feedback\nint32[] sequence";
        const HASH: &'static str = "RIHS01_c1de71afd52e49a89c53d8262366884185bc0a02f78ce051c4e46b0a7fe59bb2";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.goal_id, to);
            Message::write(&self.feedback, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                goal_id: Message::read(from)?,
                feedback: Message::read(from)?,
            })
        }
    }
    /// `example_interfaces/action/Fibonacci_GetResult`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct FibonacciGetResult;
    impl Service for FibonacciGetResult {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_GetResult";
        const HASH: &'static str = "RIHS01_1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57";
        type Request = super::example_interfaces::FibonacciGetResultRequest;
        type Response = super::example_interfaces::FibonacciGetResultResponse;
    }
    /// `example_interfaces/action/Fibonacci_GetResult_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FibonacciGetResultRequest {
        pub goal_id: super::unique_identifier_msgs::UUID,
    }
    impl Default for FibonacciGetResultRequest {
        #[inline]
        fn default() -> Self {
            Self {
                goal_id: Default::default(),
            }
        }
    }
    impl Message for FibonacciGetResultRequest {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_GetResult_Request";
        const DEFINITION: &'static str = "unique_identifier_msgs/UUID goal_id\n================================================================================\nMSG: unique_identifier_msgs/UUID\nuint8[16] uuid";
        const HASH: &'static str = "RIHS01_c8a4f5e7d13b81286ee1043e2ecd084281cecf1ff06aaa799464f5f15479f003";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.goal_id, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                goal_id: Message::read(from)?,
            })
        }
    }
    /// `example_interfaces/action/Fibonacci_GetResult_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FibonacciGetResultResponse {
        pub status: i8,
        pub result: super::example_interfaces::FibonacciResult,
    }
    impl Default for FibonacciGetResultResponse {
        #[inline]
        fn default() -> Self {
            Self {
                status: Default::default(),
                result: Default::default(),
            }
        }
    }
    impl Message for FibonacciGetResultResponse {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_GetResult_Response";
        const DEFINITION: &'static str = "int8 status\nexample_interfaces/action/Fibonacci_Result result\n================================================================================\nMSG: example_interfaces/action/Fibonacci_Result\nint32[] sequence";
        const HASH: &'static str = "RIHS01_6021dc98ab9b4bbe395e48aa4de81ee5f68eb570f88358affcc648146668b24f";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.status);
            Message::write(&self.result, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                status: from.number()?,
                result: Message::read(from)?,
            })
        }
    }
    /// `example_interfaces/action/Fibonacci_Goal`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FibonacciGoal {
        pub order: i32,
    }
    impl Default for FibonacciGoal {
        #[inline]
        fn default() -> Self {
            Self { order: Default::default() }
        }
    }
    impl Message for FibonacciGoal {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_Goal";
        const DEFINITION: &'static str = "int32 order";
        const HASH: &'static str = "RIHS01_226cb437e4355dcd3e914f930382a3b0cc1da81545bd319ed554e95a03255f51";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.order);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { order: from.number()? })
        }
    }
    /// `example_interfaces/action/Fibonacci_Result`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FibonacciResult {
        pub sequence: alloc::vec::Vec<i32>,
    }
    impl Default for FibonacciResult {
        #[inline]
        fn default() -> Self {
            Self {
                sequence: Default::default(),
            }
        }
    }
    impl Message for FibonacciResult {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_Result";
        const DEFINITION: &'static str = "int32[] sequence";
        const HASH: &'static str = "RIHS01_fea81394f25aa4502217953f1a021fb750e79c10bbd43f13dd94632da6569649";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.sequence.len());
            to.numbers(&self.sequence);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                sequence: from.list(usize::MAX)?,
            })
        }
    }
    /// `example_interfaces/action/Fibonacci_SendGoal`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct FibonacciSendGoal;
    impl Service for FibonacciSendGoal {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_SendGoal";
        const HASH: &'static str = "RIHS01_d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557";
        type Request = super::example_interfaces::FibonacciSendGoalRequest;
        type Response = super::example_interfaces::FibonacciSendGoalResponse;
    }
    /// `example_interfaces/action/Fibonacci_SendGoal_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FibonacciSendGoalRequest {
        pub goal_id: super::unique_identifier_msgs::UUID,
        pub goal: super::example_interfaces::FibonacciGoal,
    }
    impl Default for FibonacciSendGoalRequest {
        #[inline]
        fn default() -> Self {
            Self {
                goal_id: Default::default(),
                goal: Default::default(),
            }
        }
    }
    impl Message for FibonacciSendGoalRequest {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_SendGoal_Request";
        const DEFINITION: &'static str = "unique_identifier_msgs/UUID goal_id\nexample_interfaces/action/Fibonacci_Goal goal\n================================================================================\nMSG: unique_identifier_msgs/UUID\nuint8[16] uuid\n================================================================================\nMSG: example_interfaces/action/Fibonacci_Goal\nint32 order";
        const HASH: &'static str = "RIHS01_3d088942b413247db536576f0286768c6be8fcd5d0c9a5d544f359fba090a238";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.goal_id, to);
            Message::write(&self.goal, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                goal_id: Message::read(from)?,
                goal: Message::read(from)?,
            })
        }
    }
    /// `example_interfaces/action/Fibonacci_SendGoal_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FibonacciSendGoalResponse {
        pub accepted: bool,
        pub stamp: super::builtin_interfaces::Time,
    }
    impl Default for FibonacciSendGoalResponse {
        #[inline]
        fn default() -> Self {
            Self {
                accepted: Default::default(),
                stamp: Default::default(),
            }
        }
    }
    impl Message for FibonacciSendGoalResponse {
        const NAME: &'static str = "example_interfaces/action/Fibonacci_SendGoal_Response";
        const DEFINITION: &'static str = "bool accepted\nbuiltin_interfaces/Time stamp\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_d8c07bb3d5b766fe4b43159c9a5222af5214e2fcc29229b991d826166c512be1";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.accepted);
            Message::write(&self.stamp, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                accepted: from.number()?,
                stamp: Message::read(from)?,
            })
        }
    }
    /// `example_interfaces/srv/AddTwoInts`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct AddTwoInts;
    impl Service for AddTwoInts {
        const NAME: &'static str = "example_interfaces/srv/AddTwoInts";
        const HASH: &'static str = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a";
        type Request = super::example_interfaces::AddTwoIntsRequest;
        type Response = super::example_interfaces::AddTwoIntsResponse;
    }
    /// `example_interfaces/srv/AddTwoInts_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct AddTwoIntsRequest {
        pub a: i64,
        pub b: i64,
    }
    impl Default for AddTwoIntsRequest {
        #[inline]
        fn default() -> Self {
            Self {
                a: Default::default(),
                b: Default::default(),
            }
        }
    }
    impl Message for AddTwoIntsRequest {
        const NAME: &'static str = "example_interfaces/srv/AddTwoInts_Request";
        const DEFINITION: &'static str = "int64 a\nint64 b";
        const HASH: &'static str = "RIHS01_000c5fd92d6b2e1a05949348f584d6d652adea1e92d691792011ac2273508302";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.a);
            to.number(self.b);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                a: from.number()?,
                b: from.number()?,
            })
        }
    }
    /// `example_interfaces/srv/AddTwoInts_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct AddTwoIntsResponse {
        pub sum: i64,
    }
    impl Default for AddTwoIntsResponse {
        #[inline]
        fn default() -> Self {
            Self { sum: Default::default() }
        }
    }
    impl Message for AddTwoIntsResponse {
        const NAME: &'static str = "example_interfaces/srv/AddTwoInts_Response";
        const DEFINITION: &'static str = "int64 sum";
        const HASH: &'static str = "RIHS01_de5c030d4af33cba2749310b249737b631594703f9300495f48bffb2b44dcc2f";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.sum);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { sum: from.number()? })
        }
    }
}
/// Package `foxglove_msgs`.
pub mod foxglove_msgs {
    use super::*;
    /// `foxglove_msgs/msg/Grid`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Grid {
        pub timestamp: super::builtin_interfaces::Time,
        pub frame_id: alloc::string::String,
        pub pose: super::geometry_msgs::Pose,
        pub column_count: u32,
        pub cell_size: super::foxglove_msgs::Vector2,
        pub row_stride: u32,
        pub cell_stride: u32,
        pub fields: alloc::vec::Vec<super::foxglove_msgs::PackedElementField>,
        pub data: alloc::vec::Vec<u8>,
    }
    impl Default for Grid {
        #[inline]
        fn default() -> Self {
            Self {
                timestamp: Default::default(),
                frame_id: Default::default(),
                pose: Default::default(),
                column_count: Default::default(),
                cell_size: Default::default(),
                row_stride: Default::default(),
                cell_stride: Default::default(),
                fields: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for Grid {
        const NAME: &'static str = "foxglove_msgs/msg/Grid";
        const DEFINITION: &'static str = "builtin_interfaces/Time timestamp\nstring frame_id\ngeometry_msgs/Pose pose\nuint32 column_count\nfoxglove_msgs/Vector2 cell_size\nuint32 row_stride\nuint32 cell_stride\nfoxglove_msgs/PackedElementField[] fields\nuint8[] data\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: foxglove_msgs/Vector2\nfloat64 x\nfloat64 y\n================================================================================\nMSG: foxglove_msgs/PackedElementField\nuint8 UNKNOWN=0\nuint8 UINT8=1\nuint8 INT8=2\nuint8 UINT16=3\nuint8 INT16=4\nuint8 UINT32=5\nuint8 INT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 type";
        const HASH: &'static str = "RIHS01_b0c6070e6d466742a149b77eda9ef066c31128f29858419125455d0943b0f867";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.timestamp, to);
            to.text(&self.frame_id);
            Message::write(&self.pose, to);
            to.number(self.column_count);
            Message::write(&self.cell_size, to);
            to.number(self.row_stride);
            to.number(self.cell_stride);
            to.length(self.fields.len());
            for element in &self.fields {
                Message::write(element, to);
            }
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                timestamp: Message::read(from)?,
                frame_id: from.text_of(usize::MAX)?,
                pose: Message::read(from)?,
                column_count: from.number()?,
                cell_size: Message::read(from)?,
                row_stride: from.number()?,
                cell_stride: from.number()?,
                fields: from.list_of(usize::MAX, |from| Message::read(from))?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `foxglove_msgs/msg/PackedElementField`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PackedElementField {
        pub name: alloc::string::String,
        pub offset: u32,
        pub r#type: u8,
    }
    impl PackedElementField {
        pub const UNKNOWN: u8 = 0;
        pub const UINT8: u8 = 1;
        pub const INT8: u8 = 2;
        pub const UINT16: u8 = 3;
        pub const INT16: u8 = 4;
        pub const UINT32: u8 = 5;
        pub const INT32: u8 = 6;
        pub const FLOAT32: u8 = 7;
        pub const FLOAT64: u8 = 8;
    }
    impl Default for PackedElementField {
        #[inline]
        fn default() -> Self {
            Self {
                name: Default::default(),
                offset: Default::default(),
                r#type: Default::default(),
            }
        }
    }
    impl Message for PackedElementField {
        const NAME: &'static str = "foxglove_msgs/msg/PackedElementField";
        const DEFINITION: &'static str = "uint8 UNKNOWN=0\nuint8 UINT8=1\nuint8 INT8=2\nuint8 UINT16=3\nuint8 INT16=4\nuint8 UINT32=5\nuint8 INT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 type";
        const HASH: &'static str = "RIHS01_465d110563897e22946a468848a8c48e55eaa77fa207c4eec9c025a6609610b0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.name);
            to.number(self.offset);
            to.number(self.r#type);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                name: from.text_of(usize::MAX)?,
                offset: from.number()?,
                r#type: from.number()?,
            })
        }
    }
    /// `foxglove_msgs/msg/Vector2`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Vector2 {
        pub x: f64,
        pub y: f64,
    }
    impl Default for Vector2 {
        #[inline]
        fn default() -> Self {
            Self {
                x: Default::default(),
                y: Default::default(),
            }
        }
    }
    impl Message for Vector2 {
        const NAME: &'static str = "foxglove_msgs/msg/Vector2";
        const DEFINITION: &'static str = "float64 x\nfloat64 y";
        const HASH: &'static str = "RIHS01_79e1a1b0db092d52b0de4251d5aa394a99d7bf4bcb479e70331eb1ba0b07796b";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.x);
            to.number(self.y);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                x: from.number()?,
                y: from.number()?,
            })
        }
    }
}
/// Package `geometry_msgs`.
pub mod geometry_msgs {
    use super::*;
    /// `geometry_msgs/msg/Accel`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Accel {
        pub linear: super::geometry_msgs::Vector3,
        pub angular: super::geometry_msgs::Vector3,
    }
    impl Default for Accel {
        #[inline]
        fn default() -> Self {
            Self {
                linear: Default::default(),
                angular: Default::default(),
            }
        }
    }
    impl Message for Accel {
        const NAME: &'static str = "geometry_msgs/msg/Accel";
        const DEFINITION: &'static str = "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_dc448243ded9b1fcbcca24aba0c22f013dae06c354ba2d849571c0a2a3f57ca0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.linear, to);
            Message::write(&self.angular, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                linear: Message::read(from)?,
                angular: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/AccelStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct AccelStamped {
        pub header: super::std_msgs::Header,
        pub accel: super::geometry_msgs::Accel,
    }
    impl Default for AccelStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                accel: Default::default(),
            }
        }
    }
    impl Message for AccelStamped {
        const NAME: &'static str = "geometry_msgs/msg/AccelStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Accel accel\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Accel\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_ef1df9eabae0a708cc049a061ebcddc4e2a5f745730100ba680e086a9698b165";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.accel, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                accel: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/AccelWithCovariance`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct AccelWithCovariance {
        pub accel: super::geometry_msgs::Accel,
        pub covariance: [f64; 36],
    }
    impl Default for AccelWithCovariance {
        #[inline]
        fn default() -> Self {
            Self {
                accel: Default::default(),
                covariance: [0.0; 36],
            }
        }
    }
    impl Message for AccelWithCovariance {
        const NAME: &'static str = "geometry_msgs/msg/AccelWithCovariance";
        const DEFINITION: &'static str = "geometry_msgs/Accel accel\nfloat64[36] covariance\n================================================================================\nMSG: geometry_msgs/Accel\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_230d51bd53bc36f260574e73b42941cefe44684753480b6fc330c032c5db5997";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.accel, to);
            to.numbers(&self.covariance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                accel: Message::read(from)?,
                covariance: from.array()?,
            })
        }
    }
    /// `geometry_msgs/msg/AccelWithCovarianceStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct AccelWithCovarianceStamped {
        pub header: super::std_msgs::Header,
        pub accel: super::geometry_msgs::AccelWithCovariance,
    }
    impl Default for AccelWithCovarianceStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                accel: Default::default(),
            }
        }
    }
    impl Message for AccelWithCovarianceStamped {
        const NAME: &'static str = "geometry_msgs/msg/AccelWithCovarianceStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/AccelWithCovariance accel\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/AccelWithCovariance\ngeometry_msgs/Accel accel\nfloat64[36] covariance\n================================================================================\nMSG: geometry_msgs/Accel\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_61c9ad8928e71dd95ce791b2f02809ee2a0bbcc42cd0e4047fd00a822a08e444";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.accel, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                accel: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Inertia`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Inertia {
        pub m: f64,
        pub com: super::geometry_msgs::Vector3,
        pub ixx: f64,
        pub ixy: f64,
        pub ixz: f64,
        pub iyy: f64,
        pub iyz: f64,
        pub izz: f64,
    }
    impl Default for Inertia {
        #[inline]
        fn default() -> Self {
            Self {
                m: Default::default(),
                com: Default::default(),
                ixx: Default::default(),
                ixy: Default::default(),
                ixz: Default::default(),
                iyy: Default::default(),
                iyz: Default::default(),
                izz: Default::default(),
            }
        }
    }
    impl Message for Inertia {
        const NAME: &'static str = "geometry_msgs/msg/Inertia";
        const DEFINITION: &'static str = "float64 m\ngeometry_msgs/Vector3 com\nfloat64 ixx\nfloat64 ixy\nfloat64 ixz\nfloat64 iyy\nfloat64 iyz\nfloat64 izz\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_2ddd5dab5c347825ba2e56c895ddccfd0b8efe53ae931bf67f905529930b4bd7";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.m);
            Message::write(&self.com, to);
            to.number(self.ixx);
            to.number(self.ixy);
            to.number(self.ixz);
            to.number(self.iyy);
            to.number(self.iyz);
            to.number(self.izz);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                m: from.number()?,
                com: Message::read(from)?,
                ixx: from.number()?,
                ixy: from.number()?,
                ixz: from.number()?,
                iyy: from.number()?,
                iyz: from.number()?,
                izz: from.number()?,
            })
        }
    }
    /// `geometry_msgs/msg/InertiaStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct InertiaStamped {
        pub header: super::std_msgs::Header,
        pub inertia: super::geometry_msgs::Inertia,
    }
    impl Default for InertiaStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                inertia: Default::default(),
            }
        }
    }
    impl Message for InertiaStamped {
        const NAME: &'static str = "geometry_msgs/msg/InertiaStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Inertia inertia\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Inertia\nfloat64 m\ngeometry_msgs/Vector3 com\nfloat64 ixx\nfloat64 ixy\nfloat64 ixz\nfloat64 iyy\nfloat64 iyz\nfloat64 izz\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_766be45976252babf7f9d8ac4ae7c912a7ceccf71035622529f27518b695aa09";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.inertia, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                inertia: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Point`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Point {
        pub x: f64,
        pub y: f64,
        pub z: f64,
    }
    impl Default for Point {
        #[inline]
        fn default() -> Self {
            Self {
                x: Default::default(),
                y: Default::default(),
                z: Default::default(),
            }
        }
    }
    impl Message for Point {
        const NAME: &'static str = "geometry_msgs/msg/Point";
        const DEFINITION: &'static str = "float64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.x);
            to.number(self.y);
            to.number(self.z);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                x: from.number()?,
                y: from.number()?,
                z: from.number()?,
            })
        }
    }
    /// `geometry_msgs/msg/Point32`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Point32 {
        pub x: f32,
        pub y: f32,
        pub z: f32,
    }
    impl Default for Point32 {
        #[inline]
        fn default() -> Self {
            Self {
                x: Default::default(),
                y: Default::default(),
                z: Default::default(),
            }
        }
    }
    impl Message for Point32 {
        const NAME: &'static str = "geometry_msgs/msg/Point32";
        const DEFINITION: &'static str = "float32 x\nfloat32 y\nfloat32 z";
        const HASH: &'static str = "RIHS01_2fc4db7cae16a4582c79a56b66173a8d48d52c7dc520ddc55a0d4bcf2a4bfdbc";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.x);
            to.number(self.y);
            to.number(self.z);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                x: from.number()?,
                y: from.number()?,
                z: from.number()?,
            })
        }
    }
    /// `geometry_msgs/msg/PointStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PointStamped {
        pub header: super::std_msgs::Header,
        pub point: super::geometry_msgs::Point,
    }
    impl Default for PointStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                point: Default::default(),
            }
        }
    }
    impl Message for PointStamped {
        const NAME: &'static str = "geometry_msgs/msg/PointStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Point point\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_4c0296af86e01e562e9e0405d138a01537247580076c58ea38d7923ac1045897";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.point, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                point: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Polygon`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Polygon {
        pub points: alloc::vec::Vec<super::geometry_msgs::Point32>,
    }
    impl Default for Polygon {
        #[inline]
        fn default() -> Self {
            Self { points: Default::default() }
        }
    }
    impl Message for Polygon {
        const NAME: &'static str = "geometry_msgs/msg/Polygon";
        const DEFINITION: &'static str = "geometry_msgs/Point32[] points\n================================================================================\nMSG: geometry_msgs/Point32\nfloat32 x\nfloat32 y\nfloat32 z";
        const HASH: &'static str = "RIHS01_3782f9f0bf044964d692d6c017d705e37611afb1f0bf6a9dee248a7dda0f784a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.points.len());
            for element in &self.points {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                points: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `geometry_msgs/msg/PolygonInstance`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PolygonInstance {
        pub polygon: super::geometry_msgs::Polygon,
        pub id: i64,
    }
    impl Default for PolygonInstance {
        #[inline]
        fn default() -> Self {
            Self {
                polygon: Default::default(),
                id: Default::default(),
            }
        }
    }
    impl Message for PolygonInstance {
        const NAME: &'static str = "geometry_msgs/msg/PolygonInstance";
        const DEFINITION: &'static str = "geometry_msgs/Polygon polygon\nint64 id\n================================================================================\nMSG: geometry_msgs/Polygon\ngeometry_msgs/Point32[] points\n================================================================================\nMSG: geometry_msgs/Point32\nfloat32 x\nfloat32 y\nfloat32 z";
        const HASH: &'static str = "RIHS01_fa1cb3dc774329865258afef74f65b0553d487510c6d0f93ba38cc32d62ac0e5";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.polygon, to);
            to.number(self.id);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                polygon: Message::read(from)?,
                id: from.number()?,
            })
        }
    }
    /// `geometry_msgs/msg/PolygonInstanceStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PolygonInstanceStamped {
        pub header: super::std_msgs::Header,
        pub polygon: super::geometry_msgs::PolygonInstance,
    }
    impl Default for PolygonInstanceStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                polygon: Default::default(),
            }
        }
    }
    impl Message for PolygonInstanceStamped {
        const NAME: &'static str = "geometry_msgs/msg/PolygonInstanceStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/PolygonInstance polygon\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/PolygonInstance\ngeometry_msgs/Polygon polygon\nint64 id\n================================================================================\nMSG: geometry_msgs/Polygon\ngeometry_msgs/Point32[] points\n================================================================================\nMSG: geometry_msgs/Point32\nfloat32 x\nfloat32 y\nfloat32 z";
        const HASH: &'static str = "RIHS01_802f37ea4398d7ce547936aab1fd278923716a13c63373887cd896957434ce2f";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.polygon, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                polygon: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/PolygonStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PolygonStamped {
        pub header: super::std_msgs::Header,
        pub polygon: super::geometry_msgs::Polygon,
    }
    impl Default for PolygonStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                polygon: Default::default(),
            }
        }
    }
    impl Message for PolygonStamped {
        const NAME: &'static str = "geometry_msgs/msg/PolygonStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Polygon polygon\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Polygon\ngeometry_msgs/Point32[] points\n================================================================================\nMSG: geometry_msgs/Point32\nfloat32 x\nfloat32 y\nfloat32 z";
        const HASH: &'static str = "RIHS01_b7cf07932f1523d4b4088075945c1a0141f7cd21da87cc940fc61652e9138b46";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.polygon, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                polygon: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Pose`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Pose {
        pub position: super::geometry_msgs::Point,
        pub orientation: super::geometry_msgs::Quaternion,
    }
    impl Default for Pose {
        #[inline]
        fn default() -> Self {
            Self {
                position: Default::default(),
                orientation: Default::default(),
            }
        }
    }
    impl Message for Pose {
        const NAME: &'static str = "geometry_msgs/msg/Pose";
        const DEFINITION: &'static str = "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_d501954e9476cea2996984e812054b68026ae0bfae789d9a10b23daf35cc90fa";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.position, to);
            Message::write(&self.orientation, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                position: Message::read(from)?,
                orientation: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Pose2D`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Pose2D {
        pub x: f64,
        pub y: f64,
        pub theta: f64,
    }
    impl Default for Pose2D {
        #[inline]
        fn default() -> Self {
            Self {
                x: Default::default(),
                y: Default::default(),
                theta: Default::default(),
            }
        }
    }
    impl Message for Pose2D {
        const NAME: &'static str = "geometry_msgs/msg/Pose2D";
        const DEFINITION: &'static str = "float64 x\nfloat64 y\nfloat64 theta";
        const HASH: &'static str = "RIHS01_d68efa5b46e70f7b16ca23085474fdac5a44b638783ec42f661da64da4724ccc";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.x);
            to.number(self.y);
            to.number(self.theta);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                x: from.number()?,
                y: from.number()?,
                theta: from.number()?,
            })
        }
    }
    /// `geometry_msgs/msg/PoseArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PoseArray {
        pub header: super::std_msgs::Header,
        pub poses: alloc::vec::Vec<super::geometry_msgs::Pose>,
    }
    impl Default for PoseArray {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                poses: Default::default(),
            }
        }
    }
    impl Message for PoseArray {
        const NAME: &'static str = "geometry_msgs/msg/PoseArray";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Pose[] poses\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_af0cc36d190e104d546d168d6b39df04fa4b4ccecf59cb4c9ed328d3d5004aa0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.poses.len());
            for element in &self.poses {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                poses: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `geometry_msgs/msg/PoseStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PoseStamped {
        pub header: super::std_msgs::Header,
        pub pose: super::geometry_msgs::Pose,
    }
    impl Default for PoseStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                pose: Default::default(),
            }
        }
    }
    impl Message for PoseStamped {
        const NAME: &'static str = "geometry_msgs/msg/PoseStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Pose pose\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.pose, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                pose: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/PoseWithCovariance`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PoseWithCovariance {
        pub pose: super::geometry_msgs::Pose,
        pub covariance: [f64; 36],
    }
    impl Default for PoseWithCovariance {
        #[inline]
        fn default() -> Self {
            Self {
                pose: Default::default(),
                covariance: [0.0; 36],
            }
        }
    }
    impl Message for PoseWithCovariance {
        const NAME: &'static str = "geometry_msgs/msg/PoseWithCovariance";
        const DEFINITION: &'static str = "geometry_msgs/Pose pose\nfloat64[36] covariance\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_9a7c0fd234b7f45c6098745ecccd773ca1085670e64107135397aee31c02e1bb";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.pose, to);
            to.numbers(&self.covariance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                pose: Message::read(from)?,
                covariance: from.array()?,
            })
        }
    }
    /// `geometry_msgs/msg/PoseWithCovarianceStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PoseWithCovarianceStamped {
        pub header: super::std_msgs::Header,
        pub pose: super::geometry_msgs::PoseWithCovariance,
    }
    impl Default for PoseWithCovarianceStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                pose: Default::default(),
            }
        }
    }
    impl Message for PoseWithCovarianceStamped {
        const NAME: &'static str = "geometry_msgs/msg/PoseWithCovarianceStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/PoseWithCovariance\ngeometry_msgs/Pose pose\nfloat64[36] covariance\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.pose, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                pose: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Quaternion`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Quaternion {
        pub x: f64,
        pub y: f64,
        pub z: f64,
        pub w: f64,
    }
    impl Default for Quaternion {
        #[inline]
        fn default() -> Self {
            Self {
                x: 0.0,
                y: 0.0,
                z: 0.0,
                w: 1.0,
            }
        }
    }
    impl Message for Quaternion {
        const NAME: &'static str = "geometry_msgs/msg/Quaternion";
        const DEFINITION: &'static str = "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_8a765f66778c8ff7c8ab94afcc590a2ed5325a1d9a076ffff38fbce36f458684";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.x);
            to.number(self.y);
            to.number(self.z);
            to.number(self.w);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                x: from.number()?,
                y: from.number()?,
                z: from.number()?,
                w: from.number()?,
            })
        }
    }
    /// `geometry_msgs/msg/QuaternionStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct QuaternionStamped {
        pub header: super::std_msgs::Header,
        pub quaternion: super::geometry_msgs::Quaternion,
    }
    impl Default for QuaternionStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                quaternion: Default::default(),
            }
        }
    }
    impl Message for QuaternionStamped {
        const NAME: &'static str = "geometry_msgs/msg/QuaternionStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Quaternion quaternion\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_381add86c6c3160644d228ca342182c7fd6c7fab11c7a85ad817a9cc22dbac6e";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.quaternion, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                quaternion: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Transform`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Transform {
        pub translation: super::geometry_msgs::Vector3,
        pub rotation: super::geometry_msgs::Quaternion,
    }
    impl Default for Transform {
        #[inline]
        fn default() -> Self {
            Self {
                translation: Default::default(),
                rotation: Default::default(),
            }
        }
    }
    impl Message for Transform {
        const NAME: &'static str = "geometry_msgs/msg/Transform";
        const DEFINITION: &'static str = "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_beb83fbe698636351461f6f35d1abb20010c43d55374d81bd041f1ba2581fddc";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.translation, to);
            Message::write(&self.rotation, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                translation: Message::read(from)?,
                rotation: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/TransformStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TransformStamped {
        pub header: super::std_msgs::Header,
        pub child_frame_id: alloc::string::String,
        pub transform: super::geometry_msgs::Transform,
    }
    impl Default for TransformStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                child_frame_id: Default::default(),
                transform: Default::default(),
            }
        }
    }
    impl Message for TransformStamped {
        const NAME: &'static str = "geometry_msgs/msg/TransformStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.text(&self.child_frame_id);
            Message::write(&self.transform, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                child_frame_id: from.text_of(usize::MAX)?,
                transform: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Twist`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Twist {
        pub linear: super::geometry_msgs::Vector3,
        pub angular: super::geometry_msgs::Vector3,
    }
    impl Default for Twist {
        #[inline]
        fn default() -> Self {
            Self {
                linear: Default::default(),
                angular: Default::default(),
            }
        }
    }
    impl Message for Twist {
        const NAME: &'static str = "geometry_msgs/msg/Twist";
        const DEFINITION: &'static str = "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.linear, to);
            Message::write(&self.angular, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                linear: Message::read(from)?,
                angular: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/TwistStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TwistStamped {
        pub header: super::std_msgs::Header,
        pub twist: super::geometry_msgs::Twist,
    }
    impl Default for TwistStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                twist: Default::default(),
            }
        }
    }
    impl Message for TwistStamped {
        const NAME: &'static str = "geometry_msgs/msg/TwistStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Twist twist\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.twist, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                twist: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/TwistWithCovariance`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TwistWithCovariance {
        pub twist: super::geometry_msgs::Twist,
        pub covariance: [f64; 36],
    }
    impl Default for TwistWithCovariance {
        #[inline]
        fn default() -> Self {
            Self {
                twist: Default::default(),
                covariance: [0.0; 36],
            }
        }
    }
    impl Message for TwistWithCovariance {
        const NAME: &'static str = "geometry_msgs/msg/TwistWithCovariance";
        const DEFINITION: &'static str = "geometry_msgs/Twist twist\nfloat64[36] covariance\n================================================================================\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_49f574f033f095d8b6cd1beaca5ca7925e296e84af1716d16c89d38b059c8c18";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.twist, to);
            to.numbers(&self.covariance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                twist: Message::read(from)?,
                covariance: from.array()?,
            })
        }
    }
    /// `geometry_msgs/msg/TwistWithCovarianceStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TwistWithCovarianceStamped {
        pub header: super::std_msgs::Header,
        pub twist: super::geometry_msgs::TwistWithCovariance,
    }
    impl Default for TwistWithCovarianceStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                twist: Default::default(),
            }
        }
    }
    impl Message for TwistWithCovarianceStamped {
        const NAME: &'static str = "geometry_msgs/msg/TwistWithCovarianceStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/TwistWithCovariance twist\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/TwistWithCovariance\ngeometry_msgs/Twist twist\nfloat64[36] covariance\n================================================================================\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_77b67434531e6529b7a0091357b186b6ebdb17fd9ffd3e0c7ce9d3fb11a44563";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.twist, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                twist: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Vector3`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Vector3 {
        pub x: f64,
        pub y: f64,
        pub z: f64,
    }
    impl Default for Vector3 {
        #[inline]
        fn default() -> Self {
            Self {
                x: Default::default(),
                y: Default::default(),
                z: Default::default(),
            }
        }
    }
    impl Message for Vector3 {
        const NAME: &'static str = "geometry_msgs/msg/Vector3";
        const DEFINITION: &'static str = "float64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_cc12fe83e4c02719f1ce8070bfd14aecd40f75a96696a67a2a1f37f7dbb0765d";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.x);
            to.number(self.y);
            to.number(self.z);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                x: from.number()?,
                y: from.number()?,
                z: from.number()?,
            })
        }
    }
    /// `geometry_msgs/msg/Vector3Stamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Vector3Stamped {
        pub header: super::std_msgs::Header,
        pub vector: super::geometry_msgs::Vector3,
    }
    impl Default for Vector3Stamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                vector: Default::default(),
            }
        }
    }
    impl Message for Vector3Stamped {
        const NAME: &'static str = "geometry_msgs/msg/Vector3Stamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Vector3 vector\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_d4829622288cbb443886e7ea94ea5671a3b1be6bab4ad04224432a65f7d7887a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.vector, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                vector: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/VelocityStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct VelocityStamped {
        pub header: super::std_msgs::Header,
        pub body_frame_id: alloc::string::String,
        pub reference_frame_id: alloc::string::String,
        pub velocity: super::geometry_msgs::Twist,
    }
    impl Default for VelocityStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                body_frame_id: Default::default(),
                reference_frame_id: Default::default(),
                velocity: Default::default(),
            }
        }
    }
    impl Message for VelocityStamped {
        const NAME: &'static str = "geometry_msgs/msg/VelocityStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\nstring body_frame_id\nstring reference_frame_id\ngeometry_msgs/Twist velocity\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_55e7196186c8dbe4375278d7f1ac050dd8c9bacade1cf3eef8460fa667bd2457";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.text(&self.body_frame_id);
            to.text(&self.reference_frame_id);
            Message::write(&self.velocity, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                body_frame_id: from.text_of(usize::MAX)?,
                reference_frame_id: from.text_of(usize::MAX)?,
                velocity: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/Wrench`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Wrench {
        pub force: super::geometry_msgs::Vector3,
        pub torque: super::geometry_msgs::Vector3,
    }
    impl Default for Wrench {
        #[inline]
        fn default() -> Self {
            Self {
                force: Default::default(),
                torque: Default::default(),
            }
        }
    }
    impl Message for Wrench {
        const NAME: &'static str = "geometry_msgs/msg/Wrench";
        const DEFINITION: &'static str = "geometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_018e8519d57c16adbe97c9fe1460ef21fec7e31bc541de3d653a35895677ce52";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.force, to);
            Message::write(&self.torque, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                force: Message::read(from)?,
                torque: Message::read(from)?,
            })
        }
    }
    /// `geometry_msgs/msg/WrenchStamped`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct WrenchStamped {
        pub header: super::std_msgs::Header,
        pub wrench: super::geometry_msgs::Wrench,
    }
    impl Default for WrenchStamped {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                wrench: Default::default(),
            }
        }
    }
    impl Message for WrenchStamped {
        const NAME: &'static str = "geometry_msgs/msg/WrenchStamped";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_8dc3deaf06b2ab281f9f9a742a8961c328ca7cec16e3fd6586d3a5c83fa78f77";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.wrench, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                wrench: Message::read(from)?,
            })
        }
    }
}
/// Package `lifecycle_msgs`.
pub mod lifecycle_msgs {
    use super::*;
    /// `lifecycle_msgs/msg/State`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct State {
        pub id: u8,
        pub label: alloc::string::String,
    }
    impl State {
        pub const PRIMARY_STATE_UNKNOWN: u8 = 0;
        pub const PRIMARY_STATE_UNCONFIGURED: u8 = 1;
        pub const PRIMARY_STATE_INACTIVE: u8 = 2;
        pub const PRIMARY_STATE_ACTIVE: u8 = 3;
        pub const PRIMARY_STATE_FINALIZED: u8 = 4;
        pub const TRANSITION_STATE_CONFIGURING: u8 = 10;
        pub const TRANSITION_STATE_CLEANINGUP: u8 = 11;
        pub const TRANSITION_STATE_SHUTTINGDOWN: u8 = 12;
        pub const TRANSITION_STATE_ACTIVATING: u8 = 13;
        pub const TRANSITION_STATE_DEACTIVATING: u8 = 14;
        pub const TRANSITION_STATE_ERRORPROCESSING: u8 = 15;
    }
    impl Default for State {
        #[inline]
        fn default() -> Self {
            Self {
                id: Default::default(),
                label: Default::default(),
            }
        }
    }
    impl Message for State {
        const NAME: &'static str = "lifecycle_msgs/msg/State";
        const DEFINITION: &'static str = "uint8 PRIMARY_STATE_UNKNOWN=0\nuint8 PRIMARY_STATE_UNCONFIGURED=1\nuint8 PRIMARY_STATE_INACTIVE=2\nuint8 PRIMARY_STATE_ACTIVE=3\nuint8 PRIMARY_STATE_FINALIZED=4\nuint8 TRANSITION_STATE_CONFIGURING=10\nuint8 TRANSITION_STATE_CLEANINGUP=11\nuint8 TRANSITION_STATE_SHUTTINGDOWN=12\nuint8 TRANSITION_STATE_ACTIVATING=13\nuint8 TRANSITION_STATE_DEACTIVATING=14\nuint8 TRANSITION_STATE_ERRORPROCESSING=15\nuint8 id\nstring label";
        const HASH: &'static str = "RIHS01_dd2d02b82f3ebc858e53c431b1e6e91f3ffc71436fc81d0715214ac6ee2107a0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.id);
            to.text(&self.label);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                id: from.number()?,
                label: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `lifecycle_msgs/msg/Transition`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Transition {
        pub id: u8,
        pub label: alloc::string::String,
    }
    impl Transition {
        pub const TRANSITION_CREATE: u8 = 0;
        pub const TRANSITION_CONFIGURE: u8 = 1;
        pub const TRANSITION_CLEANUP: u8 = 2;
        pub const TRANSITION_ACTIVATE: u8 = 3;
        pub const TRANSITION_DEACTIVATE: u8 = 4;
        pub const TRANSITION_UNCONFIGURED_SHUTDOWN: u8 = 5;
        pub const TRANSITION_INACTIVE_SHUTDOWN: u8 = 6;
        pub const TRANSITION_ACTIVE_SHUTDOWN: u8 = 7;
        pub const TRANSITION_DESTROY: u8 = 8;
        pub const TRANSITION_ON_CONFIGURE_SUCCESS: u8 = 10;
        pub const TRANSITION_ON_CONFIGURE_FAILURE: u8 = 11;
        pub const TRANSITION_ON_CONFIGURE_ERROR: u8 = 12;
        pub const TRANSITION_ON_CLEANUP_SUCCESS: u8 = 20;
        pub const TRANSITION_ON_CLEANUP_FAILURE: u8 = 21;
        pub const TRANSITION_ON_CLEANUP_ERROR: u8 = 22;
        pub const TRANSITION_ON_ACTIVATE_SUCCESS: u8 = 30;
        pub const TRANSITION_ON_ACTIVATE_FAILURE: u8 = 31;
        pub const TRANSITION_ON_ACTIVATE_ERROR: u8 = 32;
        pub const TRANSITION_ON_DEACTIVATE_SUCCESS: u8 = 40;
        pub const TRANSITION_ON_DEACTIVATE_FAILURE: u8 = 41;
        pub const TRANSITION_ON_DEACTIVATE_ERROR: u8 = 42;
        pub const TRANSITION_ON_SHUTDOWN_SUCCESS: u8 = 50;
        pub const TRANSITION_ON_SHUTDOWN_FAILURE: u8 = 51;
        pub const TRANSITION_ON_SHUTDOWN_ERROR: u8 = 52;
        pub const TRANSITION_ON_ERROR_SUCCESS: u8 = 60;
        pub const TRANSITION_ON_ERROR_FAILURE: u8 = 61;
        pub const TRANSITION_ON_ERROR_ERROR: u8 = 62;
        pub const TRANSITION_CALLBACK_SUCCESS: u8 = 97;
        pub const TRANSITION_CALLBACK_FAILURE: u8 = 98;
        pub const TRANSITION_CALLBACK_ERROR: u8 = 99;
    }
    impl Default for Transition {
        #[inline]
        fn default() -> Self {
            Self {
                id: Default::default(),
                label: Default::default(),
            }
        }
    }
    impl Message for Transition {
        const NAME: &'static str = "lifecycle_msgs/msg/Transition";
        const DEFINITION: &'static str = "uint8 TRANSITION_CREATE=0\nuint8 TRANSITION_CONFIGURE=1\nuint8 TRANSITION_CLEANUP=2\nuint8 TRANSITION_ACTIVATE=3\nuint8 TRANSITION_DEACTIVATE=4\nuint8 TRANSITION_UNCONFIGURED_SHUTDOWN=5\nuint8 TRANSITION_INACTIVE_SHUTDOWN=6\nuint8 TRANSITION_ACTIVE_SHUTDOWN=7\nuint8 TRANSITION_DESTROY=8\nuint8 TRANSITION_ON_CONFIGURE_SUCCESS=10\nuint8 TRANSITION_ON_CONFIGURE_FAILURE=11\nuint8 TRANSITION_ON_CONFIGURE_ERROR=12\nuint8 TRANSITION_ON_CLEANUP_SUCCESS=20\nuint8 TRANSITION_ON_CLEANUP_FAILURE=21\nuint8 TRANSITION_ON_CLEANUP_ERROR=22\nuint8 TRANSITION_ON_ACTIVATE_SUCCESS=30\nuint8 TRANSITION_ON_ACTIVATE_FAILURE=31\nuint8 TRANSITION_ON_ACTIVATE_ERROR=32\nuint8 TRANSITION_ON_DEACTIVATE_SUCCESS=40\nuint8 TRANSITION_ON_DEACTIVATE_FAILURE=41\nuint8 TRANSITION_ON_DEACTIVATE_ERROR=42\nuint8 TRANSITION_ON_SHUTDOWN_SUCCESS=50\nuint8 TRANSITION_ON_SHUTDOWN_FAILURE=51\nuint8 TRANSITION_ON_SHUTDOWN_ERROR=52\nuint8 TRANSITION_ON_ERROR_SUCCESS=60\nuint8 TRANSITION_ON_ERROR_FAILURE=61\nuint8 TRANSITION_ON_ERROR_ERROR=62\nuint8 TRANSITION_CALLBACK_SUCCESS=97\nuint8 TRANSITION_CALLBACK_FAILURE=98\nuint8 TRANSITION_CALLBACK_ERROR=99\nuint8 id\nstring label";
        const HASH: &'static str = "RIHS01_c65d7b31ea134cba4f54fc867b817979be799f7452035cd35fac9b7421fb3424";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.id);
            to.text(&self.label);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                id: from.number()?,
                label: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `lifecycle_msgs/msg/TransitionDescription`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TransitionDescription {
        pub transition: super::lifecycle_msgs::Transition,
        pub start_state: super::lifecycle_msgs::State,
        pub goal_state: super::lifecycle_msgs::State,
    }
    impl Default for TransitionDescription {
        #[inline]
        fn default() -> Self {
            Self {
                transition: Default::default(),
                start_state: Default::default(),
                goal_state: Default::default(),
            }
        }
    }
    impl Message for TransitionDescription {
        const NAME: &'static str = "lifecycle_msgs/msg/TransitionDescription";
        const DEFINITION: &'static str = "lifecycle_msgs/Transition transition\nlifecycle_msgs/State start_state\nlifecycle_msgs/State goal_state\n================================================================================\nMSG: lifecycle_msgs/Transition\nuint8 TRANSITION_CREATE=0\nuint8 TRANSITION_CONFIGURE=1\nuint8 TRANSITION_CLEANUP=2\nuint8 TRANSITION_ACTIVATE=3\nuint8 TRANSITION_DEACTIVATE=4\nuint8 TRANSITION_UNCONFIGURED_SHUTDOWN=5\nuint8 TRANSITION_INACTIVE_SHUTDOWN=6\nuint8 TRANSITION_ACTIVE_SHUTDOWN=7\nuint8 TRANSITION_DESTROY=8\nuint8 TRANSITION_ON_CONFIGURE_SUCCESS=10\nuint8 TRANSITION_ON_CONFIGURE_FAILURE=11\nuint8 TRANSITION_ON_CONFIGURE_ERROR=12\nuint8 TRANSITION_ON_CLEANUP_SUCCESS=20\nuint8 TRANSITION_ON_CLEANUP_FAILURE=21\nuint8 TRANSITION_ON_CLEANUP_ERROR=22\nuint8 TRANSITION_ON_ACTIVATE_SUCCESS=30\nuint8 TRANSITION_ON_ACTIVATE_FAILURE=31\nuint8 TRANSITION_ON_ACTIVATE_ERROR=32\nuint8 TRANSITION_ON_DEACTIVATE_SUCCESS=40\nuint8 TRANSITION_ON_DEACTIVATE_FAILURE=41\nuint8 TRANSITION_ON_DEACTIVATE_ERROR=42\nuint8 TRANSITION_ON_SHUTDOWN_SUCCESS=50\nuint8 TRANSITION_ON_SHUTDOWN_FAILURE=51\nuint8 TRANSITION_ON_SHUTDOWN_ERROR=52\nuint8 TRANSITION_ON_ERROR_SUCCESS=60\nuint8 TRANSITION_ON_ERROR_FAILURE=61\nuint8 TRANSITION_ON_ERROR_ERROR=62\nuint8 TRANSITION_CALLBACK_SUCCESS=97\nuint8 TRANSITION_CALLBACK_FAILURE=98\nuint8 TRANSITION_CALLBACK_ERROR=99\nuint8 id\nstring label\n================================================================================\nMSG: lifecycle_msgs/State\nuint8 PRIMARY_STATE_UNKNOWN=0\nuint8 PRIMARY_STATE_UNCONFIGURED=1\nuint8 PRIMARY_STATE_INACTIVE=2\nuint8 PRIMARY_STATE_ACTIVE=3\nuint8 PRIMARY_STATE_FINALIZED=4\nuint8 TRANSITION_STATE_CONFIGURING=10\nuint8 TRANSITION_STATE_CLEANINGUP=11\nuint8 TRANSITION_STATE_SHUTTINGDOWN=12\nuint8 TRANSITION_STATE_ACTIVATING=13\nuint8 TRANSITION_STATE_DEACTIVATING=14\nuint8 TRANSITION_STATE_ERRORPROCESSING=15\nuint8 id\nstring label";
        const HASH: &'static str = "RIHS01_c5f1cd4bb1ad2ba0e3329d4ac7015c52a674a72c1faf7974c37a33f4f6048b28";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.transition, to);
            Message::write(&self.start_state, to);
            Message::write(&self.goal_state, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                transition: Message::read(from)?,
                start_state: Message::read(from)?,
                goal_state: Message::read(from)?,
            })
        }
    }
    /// `lifecycle_msgs/msg/TransitionEvent`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TransitionEvent {
        pub timestamp: u64,
        pub transition: super::lifecycle_msgs::Transition,
        pub start_state: super::lifecycle_msgs::State,
        pub goal_state: super::lifecycle_msgs::State,
    }
    impl Default for TransitionEvent {
        #[inline]
        fn default() -> Self {
            Self {
                timestamp: Default::default(),
                transition: Default::default(),
                start_state: Default::default(),
                goal_state: Default::default(),
            }
        }
    }
    impl Message for TransitionEvent {
        const NAME: &'static str = "lifecycle_msgs/msg/TransitionEvent";
        const DEFINITION: &'static str = "uint64 timestamp\nlifecycle_msgs/Transition transition\nlifecycle_msgs/State start_state\nlifecycle_msgs/State goal_state\n================================================================================\nMSG: lifecycle_msgs/Transition\nuint8 TRANSITION_CREATE=0\nuint8 TRANSITION_CONFIGURE=1\nuint8 TRANSITION_CLEANUP=2\nuint8 TRANSITION_ACTIVATE=3\nuint8 TRANSITION_DEACTIVATE=4\nuint8 TRANSITION_UNCONFIGURED_SHUTDOWN=5\nuint8 TRANSITION_INACTIVE_SHUTDOWN=6\nuint8 TRANSITION_ACTIVE_SHUTDOWN=7\nuint8 TRANSITION_DESTROY=8\nuint8 TRANSITION_ON_CONFIGURE_SUCCESS=10\nuint8 TRANSITION_ON_CONFIGURE_FAILURE=11\nuint8 TRANSITION_ON_CONFIGURE_ERROR=12\nuint8 TRANSITION_ON_CLEANUP_SUCCESS=20\nuint8 TRANSITION_ON_CLEANUP_FAILURE=21\nuint8 TRANSITION_ON_CLEANUP_ERROR=22\nuint8 TRANSITION_ON_ACTIVATE_SUCCESS=30\nuint8 TRANSITION_ON_ACTIVATE_FAILURE=31\nuint8 TRANSITION_ON_ACTIVATE_ERROR=32\nuint8 TRANSITION_ON_DEACTIVATE_SUCCESS=40\nuint8 TRANSITION_ON_DEACTIVATE_FAILURE=41\nuint8 TRANSITION_ON_DEACTIVATE_ERROR=42\nuint8 TRANSITION_ON_SHUTDOWN_SUCCESS=50\nuint8 TRANSITION_ON_SHUTDOWN_FAILURE=51\nuint8 TRANSITION_ON_SHUTDOWN_ERROR=52\nuint8 TRANSITION_ON_ERROR_SUCCESS=60\nuint8 TRANSITION_ON_ERROR_FAILURE=61\nuint8 TRANSITION_ON_ERROR_ERROR=62\nuint8 TRANSITION_CALLBACK_SUCCESS=97\nuint8 TRANSITION_CALLBACK_FAILURE=98\nuint8 TRANSITION_CALLBACK_ERROR=99\nuint8 id\nstring label\n================================================================================\nMSG: lifecycle_msgs/State\nuint8 PRIMARY_STATE_UNKNOWN=0\nuint8 PRIMARY_STATE_UNCONFIGURED=1\nuint8 PRIMARY_STATE_INACTIVE=2\nuint8 PRIMARY_STATE_ACTIVE=3\nuint8 PRIMARY_STATE_FINALIZED=4\nuint8 TRANSITION_STATE_CONFIGURING=10\nuint8 TRANSITION_STATE_CLEANINGUP=11\nuint8 TRANSITION_STATE_SHUTTINGDOWN=12\nuint8 TRANSITION_STATE_ACTIVATING=13\nuint8 TRANSITION_STATE_DEACTIVATING=14\nuint8 TRANSITION_STATE_ERRORPROCESSING=15\nuint8 id\nstring label";
        const HASH: &'static str = "RIHS01_d5f8873a2f0146498f812d7885c7327ce27e463d36811d8792f35ee38c0d6c38";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.timestamp);
            Message::write(&self.transition, to);
            Message::write(&self.start_state, to);
            Message::write(&self.goal_state, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                timestamp: from.number()?,
                transition: Message::read(from)?,
                start_state: Message::read(from)?,
                goal_state: Message::read(from)?,
            })
        }
    }
    /// `lifecycle_msgs/srv/ChangeState`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct ChangeState;
    impl Service for ChangeState {
        const NAME: &'static str = "lifecycle_msgs/srv/ChangeState";
        const HASH: &'static str = "RIHS01_356fe34f0475a43acf54542013af4167b0e729f77ea22ffb045c6ad8e20668e5";
        type Request = super::lifecycle_msgs::ChangeStateRequest;
        type Response = super::lifecycle_msgs::ChangeStateResponse;
    }
    /// `lifecycle_msgs/srv/ChangeState_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ChangeStateRequest {
        pub transition: super::lifecycle_msgs::Transition,
    }
    impl Default for ChangeStateRequest {
        #[inline]
        fn default() -> Self {
            Self {
                transition: Default::default(),
            }
        }
    }
    impl Message for ChangeStateRequest {
        const NAME: &'static str = "lifecycle_msgs/srv/ChangeState_Request";
        const DEFINITION: &'static str = "lifecycle_msgs/Transition transition\n================================================================================\nMSG: lifecycle_msgs/Transition\nuint8 TRANSITION_CREATE=0\nuint8 TRANSITION_CONFIGURE=1\nuint8 TRANSITION_CLEANUP=2\nuint8 TRANSITION_ACTIVATE=3\nuint8 TRANSITION_DEACTIVATE=4\nuint8 TRANSITION_UNCONFIGURED_SHUTDOWN=5\nuint8 TRANSITION_INACTIVE_SHUTDOWN=6\nuint8 TRANSITION_ACTIVE_SHUTDOWN=7\nuint8 TRANSITION_DESTROY=8\nuint8 TRANSITION_ON_CONFIGURE_SUCCESS=10\nuint8 TRANSITION_ON_CONFIGURE_FAILURE=11\nuint8 TRANSITION_ON_CONFIGURE_ERROR=12\nuint8 TRANSITION_ON_CLEANUP_SUCCESS=20\nuint8 TRANSITION_ON_CLEANUP_FAILURE=21\nuint8 TRANSITION_ON_CLEANUP_ERROR=22\nuint8 TRANSITION_ON_ACTIVATE_SUCCESS=30\nuint8 TRANSITION_ON_ACTIVATE_FAILURE=31\nuint8 TRANSITION_ON_ACTIVATE_ERROR=32\nuint8 TRANSITION_ON_DEACTIVATE_SUCCESS=40\nuint8 TRANSITION_ON_DEACTIVATE_FAILURE=41\nuint8 TRANSITION_ON_DEACTIVATE_ERROR=42\nuint8 TRANSITION_ON_SHUTDOWN_SUCCESS=50\nuint8 TRANSITION_ON_SHUTDOWN_FAILURE=51\nuint8 TRANSITION_ON_SHUTDOWN_ERROR=52\nuint8 TRANSITION_ON_ERROR_SUCCESS=60\nuint8 TRANSITION_ON_ERROR_FAILURE=61\nuint8 TRANSITION_ON_ERROR_ERROR=62\nuint8 TRANSITION_CALLBACK_SUCCESS=97\nuint8 TRANSITION_CALLBACK_FAILURE=98\nuint8 TRANSITION_CALLBACK_ERROR=99\nuint8 id\nstring label";
        const HASH: &'static str = "RIHS01_d74c6f524e14cade7b67e7297190360ed749264af300524fc1456f27cc2a553a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.transition, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                transition: Message::read(from)?,
            })
        }
    }
    /// `lifecycle_msgs/srv/ChangeState_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ChangeStateResponse {
        pub success: bool,
    }
    impl Default for ChangeStateResponse {
        #[inline]
        fn default() -> Self {
            Self {
                success: Default::default(),
            }
        }
    }
    impl Message for ChangeStateResponse {
        const NAME: &'static str = "lifecycle_msgs/srv/ChangeState_Response";
        const DEFINITION: &'static str = "bool success";
        const HASH: &'static str = "RIHS01_e1ddfed0271fefe63767aa71561926e4d9eac0f1ddf9e71a8873eb46b36deac2";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.success);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { success: from.number()? })
        }
    }
    /// `lifecycle_msgs/srv/GetAvailableStates`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct GetAvailableStates;
    impl Service for GetAvailableStates {
        const NAME: &'static str = "lifecycle_msgs/srv/GetAvailableStates";
        const HASH: &'static str = "RIHS01_00a07d79d2207d71e81a8cbc1880e5d924cc16d4688ea8e8e06e443dc8f8aa1d";
        type Request = super::lifecycle_msgs::GetAvailableStatesRequest;
        type Response = super::lifecycle_msgs::GetAvailableStatesResponse;
    }
    /// `lifecycle_msgs/srv/GetAvailableStates_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetAvailableStatesRequest {}
    impl Default for GetAvailableStatesRequest {
        #[inline]
        fn default() -> Self {
            Self {}
        }
    }
    impl Message for GetAvailableStatesRequest {
        const NAME: &'static str = "lifecycle_msgs/srv/GetAvailableStates_Request";
        const DEFINITION: &'static str = "";
        const HASH: &'static str = "RIHS01_c2c0c12de6023822f284929577d4ca2862e0501150010966e8a90b632e4424de";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(0_u8);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.empty()?;
            Ok(Self {})
        }
    }
    /// `lifecycle_msgs/srv/GetAvailableStates_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetAvailableStatesResponse {
        pub available_states: alloc::vec::Vec<super::lifecycle_msgs::State>,
    }
    impl Default for GetAvailableStatesResponse {
        #[inline]
        fn default() -> Self {
            Self {
                available_states: Default::default(),
            }
        }
    }
    impl Message for GetAvailableStatesResponse {
        const NAME: &'static str = "lifecycle_msgs/srv/GetAvailableStates_Response";
        const DEFINITION: &'static str = "lifecycle_msgs/State[] available_states\n================================================================================\nMSG: lifecycle_msgs/State\nuint8 PRIMARY_STATE_UNKNOWN=0\nuint8 PRIMARY_STATE_UNCONFIGURED=1\nuint8 PRIMARY_STATE_INACTIVE=2\nuint8 PRIMARY_STATE_ACTIVE=3\nuint8 PRIMARY_STATE_FINALIZED=4\nuint8 TRANSITION_STATE_CONFIGURING=10\nuint8 TRANSITION_STATE_CLEANINGUP=11\nuint8 TRANSITION_STATE_SHUTTINGDOWN=12\nuint8 TRANSITION_STATE_ACTIVATING=13\nuint8 TRANSITION_STATE_DEACTIVATING=14\nuint8 TRANSITION_STATE_ERRORPROCESSING=15\nuint8 id\nstring label";
        const HASH: &'static str = "RIHS01_223e0dd5bb8a847ebb9532adaf8b5e2a97e6e68e79faeaabd81a45fb32925bd1";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.available_states.len());
            for element in &self.available_states {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                available_states: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `lifecycle_msgs/srv/GetAvailableTransitions`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct GetAvailableTransitions;
    impl Service for GetAvailableTransitions {
        const NAME: &'static str = "lifecycle_msgs/srv/GetAvailableTransitions";
        const HASH: &'static str = "RIHS01_59b7ecefce0982a8a844b9f2c4f14764c1c4543cc55e72924e2aa4adad83e9bc";
        type Request = super::lifecycle_msgs::GetAvailableTransitionsRequest;
        type Response = super::lifecycle_msgs::GetAvailableTransitionsResponse;
    }
    /// `lifecycle_msgs/srv/GetAvailableTransitions_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetAvailableTransitionsRequest {}
    impl Default for GetAvailableTransitionsRequest {
        #[inline]
        fn default() -> Self {
            Self {}
        }
    }
    impl Message for GetAvailableTransitionsRequest {
        const NAME: &'static str = "lifecycle_msgs/srv/GetAvailableTransitions_Request";
        const DEFINITION: &'static str = "";
        const HASH: &'static str = "RIHS01_52a73c0b5d7489bee0df6ddb0aec45c41289d223ff225b58fe11d859ac8109a6";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(0_u8);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.empty()?;
            Ok(Self {})
        }
    }
    /// `lifecycle_msgs/srv/GetAvailableTransitions_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetAvailableTransitionsResponse {
        pub available_transitions: alloc::vec::Vec<
            super::lifecycle_msgs::TransitionDescription,
        >,
    }
    impl Default for GetAvailableTransitionsResponse {
        #[inline]
        fn default() -> Self {
            Self {
                available_transitions: Default::default(),
            }
        }
    }
    impl Message for GetAvailableTransitionsResponse {
        const NAME: &'static str = "lifecycle_msgs/srv/GetAvailableTransitions_Response";
        const DEFINITION: &'static str = "lifecycle_msgs/TransitionDescription[] available_transitions\n================================================================================\nMSG: lifecycle_msgs/TransitionDescription\nlifecycle_msgs/Transition transition\nlifecycle_msgs/State start_state\nlifecycle_msgs/State goal_state\n================================================================================\nMSG: lifecycle_msgs/Transition\nuint8 TRANSITION_CREATE=0\nuint8 TRANSITION_CONFIGURE=1\nuint8 TRANSITION_CLEANUP=2\nuint8 TRANSITION_ACTIVATE=3\nuint8 TRANSITION_DEACTIVATE=4\nuint8 TRANSITION_UNCONFIGURED_SHUTDOWN=5\nuint8 TRANSITION_INACTIVE_SHUTDOWN=6\nuint8 TRANSITION_ACTIVE_SHUTDOWN=7\nuint8 TRANSITION_DESTROY=8\nuint8 TRANSITION_ON_CONFIGURE_SUCCESS=10\nuint8 TRANSITION_ON_CONFIGURE_FAILURE=11\nuint8 TRANSITION_ON_CONFIGURE_ERROR=12\nuint8 TRANSITION_ON_CLEANUP_SUCCESS=20\nuint8 TRANSITION_ON_CLEANUP_FAILURE=21\nuint8 TRANSITION_ON_CLEANUP_ERROR=22\nuint8 TRANSITION_ON_ACTIVATE_SUCCESS=30\nuint8 TRANSITION_ON_ACTIVATE_FAILURE=31\nuint8 TRANSITION_ON_ACTIVATE_ERROR=32\nuint8 TRANSITION_ON_DEACTIVATE_SUCCESS=40\nuint8 TRANSITION_ON_DEACTIVATE_FAILURE=41\nuint8 TRANSITION_ON_DEACTIVATE_ERROR=42\nuint8 TRANSITION_ON_SHUTDOWN_SUCCESS=50\nuint8 TRANSITION_ON_SHUTDOWN_FAILURE=51\nuint8 TRANSITION_ON_SHUTDOWN_ERROR=52\nuint8 TRANSITION_ON_ERROR_SUCCESS=60\nuint8 TRANSITION_ON_ERROR_FAILURE=61\nuint8 TRANSITION_ON_ERROR_ERROR=62\nuint8 TRANSITION_CALLBACK_SUCCESS=97\nuint8 TRANSITION_CALLBACK_FAILURE=98\nuint8 TRANSITION_CALLBACK_ERROR=99\nuint8 id\nstring label\n================================================================================\nMSG: lifecycle_msgs/State\nuint8 PRIMARY_STATE_UNKNOWN=0\nuint8 PRIMARY_STATE_UNCONFIGURED=1\nuint8 PRIMARY_STATE_INACTIVE=2\nuint8 PRIMARY_STATE_ACTIVE=3\nuint8 PRIMARY_STATE_FINALIZED=4\nuint8 TRANSITION_STATE_CONFIGURING=10\nuint8 TRANSITION_STATE_CLEANINGUP=11\nuint8 TRANSITION_STATE_SHUTTINGDOWN=12\nuint8 TRANSITION_STATE_ACTIVATING=13\nuint8 TRANSITION_STATE_DEACTIVATING=14\nuint8 TRANSITION_STATE_ERRORPROCESSING=15\nuint8 id\nstring label";
        const HASH: &'static str = "RIHS01_4711339461aadf02bcfff797a198de911f885074bd3f2fe9f7b677ef87f0741c";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.available_transitions.len());
            for element in &self.available_transitions {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                available_transitions: from
                    .list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `lifecycle_msgs/srv/GetState`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct GetState;
    impl Service for GetState {
        const NAME: &'static str = "lifecycle_msgs/srv/GetState";
        const HASH: &'static str = "RIHS01_800a0a5aae599782b02932de0caf563f6dc4e7e94b794eadde075ba2cbef9795";
        type Request = super::lifecycle_msgs::GetStateRequest;
        type Response = super::lifecycle_msgs::GetStateResponse;
    }
    /// `lifecycle_msgs/srv/GetState_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetStateRequest {}
    impl Default for GetStateRequest {
        #[inline]
        fn default() -> Self {
            Self {}
        }
    }
    impl Message for GetStateRequest {
        const NAME: &'static str = "lifecycle_msgs/srv/GetState_Request";
        const DEFINITION: &'static str = "";
        const HASH: &'static str = "RIHS01_77a9c844e7975f15bc2221e8bbebafc4d118afb78c7f7071eef91f83f940f2f6";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(0_u8);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.empty()?;
            Ok(Self {})
        }
    }
    /// `lifecycle_msgs/srv/GetState_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetStateResponse {
        pub current_state: super::lifecycle_msgs::State,
    }
    impl Default for GetStateResponse {
        #[inline]
        fn default() -> Self {
            Self {
                current_state: Default::default(),
            }
        }
    }
    impl Message for GetStateResponse {
        const NAME: &'static str = "lifecycle_msgs/srv/GetState_Response";
        const DEFINITION: &'static str = "lifecycle_msgs/State current_state\n================================================================================\nMSG: lifecycle_msgs/State\nuint8 PRIMARY_STATE_UNKNOWN=0\nuint8 PRIMARY_STATE_UNCONFIGURED=1\nuint8 PRIMARY_STATE_INACTIVE=2\nuint8 PRIMARY_STATE_ACTIVE=3\nuint8 PRIMARY_STATE_FINALIZED=4\nuint8 TRANSITION_STATE_CONFIGURING=10\nuint8 TRANSITION_STATE_CLEANINGUP=11\nuint8 TRANSITION_STATE_SHUTTINGDOWN=12\nuint8 TRANSITION_STATE_ACTIVATING=13\nuint8 TRANSITION_STATE_DEACTIVATING=14\nuint8 TRANSITION_STATE_ERRORPROCESSING=15\nuint8 id\nstring label";
        const HASH: &'static str = "RIHS01_fe249babab472e42cb5653b5d6a6b0c42a003b0fdfb84851aea3fde08760b4f5";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.current_state, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                current_state: Message::read(from)?,
            })
        }
    }
}
/// Package `nav_msgs`.
pub mod nav_msgs {
    use super::*;
    /// `nav_msgs/msg/Goals`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Goals {
        pub header: super::std_msgs::Header,
        pub goals: alloc::vec::Vec<super::geometry_msgs::PoseStamped>,
    }
    impl Default for Goals {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                goals: Default::default(),
            }
        }
    }
    impl Message for Goals {
        const NAME: &'static str = "nav_msgs/msg/Goals";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/PoseStamped[] goals\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/PoseStamped\nstd_msgs/Header header\ngeometry_msgs/Pose pose\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_02305a51633b5c04d8979b878a7577cafd422f8a07465c878b17a920af3759e9";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.goals.len());
            for element in &self.goals {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                goals: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `nav_msgs/msg/GridCells`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GridCells {
        pub header: super::std_msgs::Header,
        pub cell_width: f32,
        pub cell_height: f32,
        pub cells: alloc::vec::Vec<super::geometry_msgs::Point>,
    }
    impl Default for GridCells {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                cell_width: Default::default(),
                cell_height: Default::default(),
                cells: Default::default(),
            }
        }
    }
    impl Message for GridCells {
        const NAME: &'static str = "nav_msgs/msg/GridCells";
        const DEFINITION: &'static str = "std_msgs/Header header\nfloat32 cell_width\nfloat32 cell_height\ngeometry_msgs/Point[] cells\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_bb99c2f5d0a04750745a81ec6a8147aa373cce5bd17c8cd6507f2413354a6933";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.cell_width);
            to.number(self.cell_height);
            to.length(self.cells.len());
            for element in &self.cells {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                cell_width: from.number()?,
                cell_height: from.number()?,
                cells: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `nav_msgs/msg/MapMetaData`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MapMetaData {
        pub map_load_time: super::builtin_interfaces::Time,
        pub resolution: f32,
        pub width: u32,
        pub height: u32,
        pub origin: super::geometry_msgs::Pose,
    }
    impl Default for MapMetaData {
        #[inline]
        fn default() -> Self {
            Self {
                map_load_time: Default::default(),
                resolution: Default::default(),
                width: Default::default(),
                height: Default::default(),
                origin: Default::default(),
            }
        }
    }
    impl Message for MapMetaData {
        const NAME: &'static str = "nav_msgs/msg/MapMetaData";
        const DEFINITION: &'static str = "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\ngeometry_msgs/Pose origin\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_2772d4b2000ef2b35dbaeb80fd3946c1369f817fb4f75677d916d27c17d763c8";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.map_load_time, to);
            to.number(self.resolution);
            to.number(self.width);
            to.number(self.height);
            Message::write(&self.origin, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                map_load_time: Message::read(from)?,
                resolution: from.number()?,
                width: from.number()?,
                height: from.number()?,
                origin: Message::read(from)?,
            })
        }
    }
    /// `nav_msgs/msg/OccupancyGrid`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct OccupancyGrid {
        pub header: super::std_msgs::Header,
        pub info: super::nav_msgs::MapMetaData,
        pub data: alloc::vec::Vec<i8>,
    }
    impl Default for OccupancyGrid {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                info: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for OccupancyGrid {
        const NAME: &'static str = "nav_msgs/msg/OccupancyGrid";
        const DEFINITION: &'static str = "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: nav_msgs/MapMetaData\nbuiltin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\ngeometry_msgs/Pose origin\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.info, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                info: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `nav_msgs/msg/Odometry`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Odometry {
        pub header: super::std_msgs::Header,
        pub child_frame_id: alloc::string::String,
        pub pose: super::geometry_msgs::PoseWithCovariance,
        pub twist: super::geometry_msgs::TwistWithCovariance,
    }
    impl Default for Odometry {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                child_frame_id: Default::default(),
                pose: Default::default(),
                twist: Default::default(),
            }
        }
    }
    impl Message for Odometry {
        const NAME: &'static str = "nav_msgs/msg/Odometry";
        const DEFINITION: &'static str = "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/PoseWithCovariance\ngeometry_msgs/Pose pose\nfloat64[36] covariance\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: geometry_msgs/TwistWithCovariance\ngeometry_msgs/Twist twist\nfloat64[36] covariance\n================================================================================\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.text(&self.child_frame_id);
            Message::write(&self.pose, to);
            Message::write(&self.twist, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                child_frame_id: from.text_of(usize::MAX)?,
                pose: Message::read(from)?,
                twist: Message::read(from)?,
            })
        }
    }
    /// `nav_msgs/msg/Path`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Path {
        pub header: super::std_msgs::Header,
        pub poses: alloc::vec::Vec<super::geometry_msgs::PoseStamped>,
    }
    impl Default for Path {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                poses: Default::default(),
            }
        }
    }
    impl Message for Path {
        const NAME: &'static str = "nav_msgs/msg/Path";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/PoseStamped\nstd_msgs/Header header\ngeometry_msgs/Pose pose\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.poses.len());
            for element in &self.poses {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                poses: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `nav_msgs/srv/GetMap`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct GetMap;
    impl Service for GetMap {
        const NAME: &'static str = "nav_msgs/srv/GetMap";
        const HASH: &'static str = "RIHS01_c8ae77c9995b3554b5ba80e4d4d443f970ac65143102a1d893ec24fc07b31147";
        type Request = super::nav_msgs::GetMapRequest;
        type Response = super::nav_msgs::GetMapResponse;
    }
    /// `nav_msgs/srv/GetMap_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetMapRequest {}
    impl Default for GetMapRequest {
        #[inline]
        fn default() -> Self {
            Self {}
        }
    }
    impl Message for GetMapRequest {
        const NAME: &'static str = "nav_msgs/srv/GetMap_Request";
        const DEFINITION: &'static str = "";
        const HASH: &'static str = "RIHS01_b531e302f1bd6a81f8a5e03453266c378b1f711b4296000c1c0f53a40e00a7c4";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(0_u8);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.empty()?;
            Ok(Self {})
        }
    }
    /// `nav_msgs/srv/GetMap_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetMapResponse {
        pub map: super::nav_msgs::OccupancyGrid,
    }
    impl Default for GetMapResponse {
        #[inline]
        fn default() -> Self {
            Self { map: Default::default() }
        }
    }
    impl Message for GetMapResponse {
        const NAME: &'static str = "nav_msgs/srv/GetMap_Response";
        const DEFINITION: &'static str = "nav_msgs/OccupancyGrid map\n================================================================================\nMSG: nav_msgs/OccupancyGrid\nstd_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: nav_msgs/MapMetaData\nbuiltin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\ngeometry_msgs/Pose origin\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_45246f7a2ff0cbfa46e13865d4b95929ebb6d2846d1b85a20ad51030f4690dc2";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.map, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { map: Message::read(from)? })
        }
    }
    /// `nav_msgs/srv/GetPlan`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct GetPlan;
    impl Service for GetPlan {
        const NAME: &'static str = "nav_msgs/srv/GetPlan";
        const HASH: &'static str = "RIHS01_234f7aff100f5edb8150366601687b027bcdc253db47decb88fff846193fe5e8";
        type Request = super::nav_msgs::GetPlanRequest;
        type Response = super::nav_msgs::GetPlanResponse;
    }
    /// `nav_msgs/srv/GetPlan_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetPlanRequest {
        pub start: super::geometry_msgs::PoseStamped,
        pub goal: super::geometry_msgs::PoseStamped,
        pub tolerance: f32,
    }
    impl Default for GetPlanRequest {
        #[inline]
        fn default() -> Self {
            Self {
                start: Default::default(),
                goal: Default::default(),
                tolerance: Default::default(),
            }
        }
    }
    impl Message for GetPlanRequest {
        const NAME: &'static str = "nav_msgs/srv/GetPlan_Request";
        const DEFINITION: &'static str = "geometry_msgs/PoseStamped start\ngeometry_msgs/PoseStamped goal\nfloat32 tolerance\n================================================================================\nMSG: geometry_msgs/PoseStamped\nstd_msgs/Header header\ngeometry_msgs/Pose pose\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_f1bb9fab287948b4432a4a7e4f529e7ea6269cd06269ee8fcb911fdb4acd23c3";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.start, to);
            Message::write(&self.goal, to);
            to.number(self.tolerance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                start: Message::read(from)?,
                goal: Message::read(from)?,
                tolerance: from.number()?,
            })
        }
    }
    /// `nav_msgs/srv/GetPlan_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetPlanResponse {
        pub plan: super::nav_msgs::Path,
    }
    impl Default for GetPlanResponse {
        #[inline]
        fn default() -> Self {
            Self { plan: Default::default() }
        }
    }
    impl Message for GetPlanResponse {
        const NAME: &'static str = "nav_msgs/srv/GetPlan_Response";
        const DEFINITION: &'static str = "nav_msgs/Path plan\n================================================================================\nMSG: nav_msgs/Path\nstd_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/PoseStamped\nstd_msgs/Header header\ngeometry_msgs/Pose pose\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_30a947cd360777929073296c368c591dc2117a89c15b7a975a6faa0a901836fd";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.plan, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { plan: Message::read(from)? })
        }
    }
    /// `nav_msgs/srv/LoadMap`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct LoadMap;
    impl Service for LoadMap {
        const NAME: &'static str = "nav_msgs/srv/LoadMap";
        const HASH: &'static str = "RIHS01_1a192ac56c40fed2767dac26f0b371785372276bd465c902676d2dca135aae5a";
        type Request = super::nav_msgs::LoadMapRequest;
        type Response = super::nav_msgs::LoadMapResponse;
    }
    /// `nav_msgs/srv/LoadMap_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct LoadMapRequest {
        pub map_url: alloc::string::String,
    }
    impl Default for LoadMapRequest {
        #[inline]
        fn default() -> Self {
            Self {
                map_url: Default::default(),
            }
        }
    }
    impl Message for LoadMapRequest {
        const NAME: &'static str = "nav_msgs/srv/LoadMap_Request";
        const DEFINITION: &'static str = "string map_url";
        const HASH: &'static str = "RIHS01_0f8fe3aac433c977d7c2f8b57ab1c3a17677e24880d76919b69e4208e99f5132";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.map_url);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                map_url: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `nav_msgs/srv/LoadMap_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct LoadMapResponse {
        pub map: super::nav_msgs::OccupancyGrid,
        pub result: u8,
    }
    impl LoadMapResponse {
        pub const RESULT_SUCCESS: u8 = 0;
        pub const RESULT_MAP_DOES_NOT_EXIST: u8 = 1;
        pub const RESULT_INVALID_MAP_DATA: u8 = 2;
        pub const RESULT_INVALID_MAP_METADATA: u8 = 3;
        pub const RESULT_UNDEFINED_FAILURE: u8 = 255;
    }
    impl Default for LoadMapResponse {
        #[inline]
        fn default() -> Self {
            Self {
                map: Default::default(),
                result: Default::default(),
            }
        }
    }
    impl Message for LoadMapResponse {
        const NAME: &'static str = "nav_msgs/srv/LoadMap_Response";
        const DEFINITION: &'static str = "uint8 RESULT_SUCCESS=0\nuint8 RESULT_MAP_DOES_NOT_EXIST=1\nuint8 RESULT_INVALID_MAP_DATA=2\nuint8 RESULT_INVALID_MAP_METADATA=3\nuint8 RESULT_UNDEFINED_FAILURE=255\nnav_msgs/OccupancyGrid map\nuint8 result\n================================================================================\nMSG: nav_msgs/OccupancyGrid\nstd_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: nav_msgs/MapMetaData\nbuiltin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\ngeometry_msgs/Pose origin\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_e7970ddf9f58e10d34b5eae6d2baca31b2b3e2f2fe6d082b3aae2a5f92777b2a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.map, to);
            to.number(self.result);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                map: Message::read(from)?,
                result: from.number()?,
            })
        }
    }
    /// `nav_msgs/srv/SetMap`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct SetMap;
    impl Service for SetMap {
        const NAME: &'static str = "nav_msgs/srv/SetMap";
        const HASH: &'static str = "RIHS01_5e11a5b2ca53d8ae85b666a019f16c9904ebc787828f1f566c4e048a1ddedfb4";
        type Request = super::nav_msgs::SetMapRequest;
        type Response = super::nav_msgs::SetMapResponse;
    }
    /// `nav_msgs/srv/SetMap_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetMapRequest {
        pub map: super::nav_msgs::OccupancyGrid,
        pub initial_pose: super::geometry_msgs::PoseWithCovarianceStamped,
    }
    impl Default for SetMapRequest {
        #[inline]
        fn default() -> Self {
            Self {
                map: Default::default(),
                initial_pose: Default::default(),
            }
        }
    }
    impl Message for SetMapRequest {
        const NAME: &'static str = "nav_msgs/srv/SetMap_Request";
        const DEFINITION: &'static str = "nav_msgs/OccupancyGrid map\ngeometry_msgs/PoseWithCovarianceStamped initial_pose\n================================================================================\nMSG: nav_msgs/OccupancyGrid\nstd_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: nav_msgs/MapMetaData\nbuiltin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\ngeometry_msgs/Pose origin\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: geometry_msgs/PoseWithCovarianceStamped\nstd_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n================================================================================\nMSG: geometry_msgs/PoseWithCovariance\ngeometry_msgs/Pose pose\nfloat64[36] covariance";
        const HASH: &'static str = "RIHS01_5a83a0c20af4d79248fc3287524bf358b603fb5a05818b5ec85b50fa6e5d0266";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.map, to);
            Message::write(&self.initial_pose, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                map: Message::read(from)?,
                initial_pose: Message::read(from)?,
            })
        }
    }
    /// `nav_msgs/srv/SetMap_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetMapResponse {
        pub success: bool,
    }
    impl Default for SetMapResponse {
        #[inline]
        fn default() -> Self {
            Self {
                success: Default::default(),
            }
        }
    }
    impl Message for SetMapResponse {
        const NAME: &'static str = "nav_msgs/srv/SetMap_Response";
        const DEFINITION: &'static str = "bool success";
        const HASH: &'static str = "RIHS01_e7251879322c7b12285b9c191d68d27495b6dede051f3cd79b0bf334147b7375";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.success);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { success: from.number()? })
        }
    }
}
/// Package `rcl_interfaces`.
pub mod rcl_interfaces {
    use super::*;
    /// `rcl_interfaces/msg/FloatingPointRange`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FloatingPointRange {
        pub from_value: f64,
        pub to_value: f64,
        pub step: f64,
    }
    impl Default for FloatingPointRange {
        #[inline]
        fn default() -> Self {
            Self {
                from_value: Default::default(),
                to_value: Default::default(),
                step: Default::default(),
            }
        }
    }
    impl Message for FloatingPointRange {
        const NAME: &'static str = "rcl_interfaces/msg/FloatingPointRange";
        const DEFINITION: &'static str = "float64 from_value\nfloat64 to_value\nfloat64 step";
        const HASH: &'static str = "RIHS01_e6af23a23c177fee5f3075c8b1e435162a9b63c863d78c06017460b49684262d";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.from_value);
            to.number(self.to_value);
            to.number(self.step);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                from_value: from.number()?,
                to_value: from.number()?,
                step: from.number()?,
            })
        }
    }
    /// `rcl_interfaces/msg/IntegerRange`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct IntegerRange {
        pub from_value: i64,
        pub to_value: i64,
        pub step: u64,
    }
    impl Default for IntegerRange {
        #[inline]
        fn default() -> Self {
            Self {
                from_value: Default::default(),
                to_value: Default::default(),
                step: Default::default(),
            }
        }
    }
    impl Message for IntegerRange {
        const NAME: &'static str = "rcl_interfaces/msg/IntegerRange";
        const DEFINITION: &'static str = "int64 from_value\nint64 to_value\nuint64 step";
        const HASH: &'static str = "RIHS01_f7b7fdc0f65f07702e099218e13288c3963bcb9345bde78b560e6cd19800fc5a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.from_value);
            to.number(self.to_value);
            to.number(self.step);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                from_value: from.number()?,
                to_value: from.number()?,
                step: from.number()?,
            })
        }
    }
    /// `rcl_interfaces/msg/ListParametersResult`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ListParametersResult {
        pub names: alloc::vec::Vec<alloc::string::String>,
        pub prefixes: alloc::vec::Vec<alloc::string::String>,
    }
    impl Default for ListParametersResult {
        #[inline]
        fn default() -> Self {
            Self {
                names: Default::default(),
                prefixes: Default::default(),
            }
        }
    }
    impl Message for ListParametersResult {
        const NAME: &'static str = "rcl_interfaces/msg/ListParametersResult";
        const DEFINITION: &'static str = "string[] names\nstring[] prefixes";
        const HASH: &'static str = "RIHS01_237ae3428413dcbcfb452b510c42355f3a2b021dc091afa3e18526d57022f1cd";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.names.len());
            for element in &self.names {
                to.text(element);
            }
            to.length(self.prefixes.len());
            for element in &self.prefixes {
                to.text(element);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                names: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
                prefixes: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
            })
        }
    }
    /// `rcl_interfaces/msg/Log`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Log {
        pub stamp: super::builtin_interfaces::Time,
        pub level: u8,
        pub name: alloc::string::String,
        pub msg: alloc::string::String,
        pub file: alloc::string::String,
        pub function: alloc::string::String,
        pub line: u32,
    }
    impl Log {
        pub const DEBUG: u8 = 10;
        pub const INFO: u8 = 20;
        pub const WARN: u8 = 30;
        pub const ERROR: u8 = 40;
        pub const FATAL: u8 = 50;
    }
    impl Default for Log {
        #[inline]
        fn default() -> Self {
            Self {
                stamp: Default::default(),
                level: Default::default(),
                name: Default::default(),
                msg: Default::default(),
                file: Default::default(),
                function: Default::default(),
                line: Default::default(),
            }
        }
    }
    impl Message for Log {
        const NAME: &'static str = "rcl_interfaces/msg/Log";
        const DEFINITION: &'static str = "uint8 DEBUG=10\nuint8 INFO=20\nuint8 WARN=30\nuint8 ERROR=40\nuint8 FATAL=50\nbuiltin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\nuint32 line\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.stamp, to);
            to.number(self.level);
            to.text(&self.name);
            to.text(&self.msg);
            to.text(&self.file);
            to.text(&self.function);
            to.number(self.line);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                stamp: Message::read(from)?,
                level: from.number()?,
                name: from.text_of(usize::MAX)?,
                msg: from.text_of(usize::MAX)?,
                file: from.text_of(usize::MAX)?,
                function: from.text_of(usize::MAX)?,
                line: from.number()?,
            })
        }
    }
    /// `rcl_interfaces/msg/LoggerLevel`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct LoggerLevel {
        pub name: alloc::string::String,
        pub level: u32,
    }
    impl LoggerLevel {
        pub const LOG_LEVEL_UNKNOWN: u8 = 0;
        pub const LOG_LEVEL_DEBUG: u8 = 10;
        pub const LOG_LEVEL_INFO: u8 = 20;
        pub const LOG_LEVEL_WARN: u8 = 30;
        pub const LOG_LEVEL_ERROR: u8 = 40;
        pub const LOG_LEVEL_FATAL: u8 = 50;
    }
    impl Default for LoggerLevel {
        #[inline]
        fn default() -> Self {
            Self {
                name: Default::default(),
                level: Default::default(),
            }
        }
    }
    impl Message for LoggerLevel {
        const NAME: &'static str = "rcl_interfaces/msg/LoggerLevel";
        const DEFINITION: &'static str = "uint8 LOG_LEVEL_UNKNOWN=0\nuint8 LOG_LEVEL_DEBUG=10\nuint8 LOG_LEVEL_INFO=20\nuint8 LOG_LEVEL_WARN=30\nuint8 LOG_LEVEL_ERROR=40\nuint8 LOG_LEVEL_FATAL=50\nstring name\nuint32 level";
        const HASH: &'static str = "RIHS01_95785cc42f048ab4f395af65035aeaf2181d8e1c7a44edb8ad4558445fdb43c0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.name);
            to.number(self.level);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                name: from.text_of(usize::MAX)?,
                level: from.number()?,
            })
        }
    }
    /// `rcl_interfaces/msg/Parameter`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Parameter {
        pub name: alloc::string::String,
        pub value: super::rcl_interfaces::ParameterValue,
    }
    impl Default for Parameter {
        #[inline]
        fn default() -> Self {
            Self {
                name: Default::default(),
                value: Default::default(),
            }
        }
    }
    impl Message for Parameter {
        const NAME: &'static str = "rcl_interfaces/msg/Parameter";
        const DEFINITION: &'static str = "string name\nrcl_interfaces/ParameterValue value\n================================================================================\nMSG: rcl_interfaces/ParameterValue\nuint8 type\nbool bool_value\nint64 integer_value\nfloat64 double_value\nstring string_value\nbyte[] byte_array_value\nbool[] bool_array_value\nint64[] integer_array_value\nfloat64[] double_array_value\nstring[] string_array_value";
        const HASH: &'static str = "RIHS01_ddfe6442cffc462317adb5c92536a7b6dd55858c5c3e1e328165a6b73c2831af";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.name);
            Message::write(&self.value, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                name: from.text_of(usize::MAX)?,
                value: Message::read(from)?,
            })
        }
    }
    /// `rcl_interfaces/msg/ParameterDescriptor`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ParameterDescriptor {
        pub name: alloc::string::String,
        pub r#type: u8,
        pub description: alloc::string::String,
        pub additional_constraints: alloc::string::String,
        pub read_only: bool,
        pub dynamic_typing: bool,
        pub floating_point_range: alloc::vec::Vec<
            super::rcl_interfaces::FloatingPointRange,
        >,
        pub integer_range: alloc::vec::Vec<super::rcl_interfaces::IntegerRange>,
    }
    impl Default for ParameterDescriptor {
        #[inline]
        fn default() -> Self {
            Self {
                name: Default::default(),
                r#type: Default::default(),
                description: Default::default(),
                additional_constraints: Default::default(),
                read_only: Default::default(),
                dynamic_typing: Default::default(),
                floating_point_range: Default::default(),
                integer_range: Default::default(),
            }
        }
    }
    impl Message for ParameterDescriptor {
        const NAME: &'static str = "rcl_interfaces/msg/ParameterDescriptor";
        const DEFINITION: &'static str = "string name\nuint8 type\nstring description\nstring additional_constraints\nbool read_only\nbool dynamic_typing\nrcl_interfaces/FloatingPointRange[<=1] floating_point_range\nrcl_interfaces/IntegerRange[<=1] integer_range\n================================================================================\nMSG: rcl_interfaces/FloatingPointRange\nfloat64 from_value\nfloat64 to_value\nfloat64 step\n================================================================================\nMSG: rcl_interfaces/IntegerRange\nint64 from_value\nint64 to_value\nuint64 step";
        const HASH: &'static str = "RIHS01_52175dbfda6c51153101d33d2a9da05743f66f02d5ab2ca9ec4709b46b73d704";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.name);
            to.number(self.r#type);
            to.text(&self.description);
            to.text(&self.additional_constraints);
            to.number(self.read_only);
            to.number(self.dynamic_typing);
            to.length(self.floating_point_range.len());
            for element in &self.floating_point_range {
                Message::write(element, to);
            }
            to.length(self.integer_range.len());
            for element in &self.integer_range {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                name: from.text_of(usize::MAX)?,
                r#type: from.number()?,
                description: from.text_of(usize::MAX)?,
                additional_constraints: from.text_of(usize::MAX)?,
                read_only: from.number()?,
                dynamic_typing: from.number()?,
                floating_point_range: from.list_of(1, |from| Message::read(from))?,
                integer_range: from.list_of(1, |from| Message::read(from))?,
            })
        }
    }
    /// `rcl_interfaces/msg/ParameterEvent`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ParameterEvent {
        pub stamp: super::builtin_interfaces::Time,
        pub node: alloc::string::String,
        pub new_parameters: alloc::vec::Vec<super::rcl_interfaces::Parameter>,
        pub changed_parameters: alloc::vec::Vec<super::rcl_interfaces::Parameter>,
        pub deleted_parameters: alloc::vec::Vec<super::rcl_interfaces::Parameter>,
    }
    impl Default for ParameterEvent {
        #[inline]
        fn default() -> Self {
            Self {
                stamp: Default::default(),
                node: Default::default(),
                new_parameters: Default::default(),
                changed_parameters: Default::default(),
                deleted_parameters: Default::default(),
            }
        }
    }
    impl Message for ParameterEvent {
        const NAME: &'static str = "rcl_interfaces/msg/ParameterEvent";
        const DEFINITION: &'static str = "builtin_interfaces/Time stamp\nstring node\nrcl_interfaces/Parameter[] new_parameters\nrcl_interfaces/Parameter[] changed_parameters\nrcl_interfaces/Parameter[] deleted_parameters\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: rcl_interfaces/Parameter\nstring name\nrcl_interfaces/ParameterValue value\n================================================================================\nMSG: rcl_interfaces/ParameterValue\nuint8 type\nbool bool_value\nint64 integer_value\nfloat64 double_value\nstring string_value\nbyte[] byte_array_value\nbool[] bool_array_value\nint64[] integer_array_value\nfloat64[] double_array_value\nstring[] string_array_value";
        const HASH: &'static str = "RIHS01_043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.stamp, to);
            to.text(&self.node);
            to.length(self.new_parameters.len());
            for element in &self.new_parameters {
                Message::write(element, to);
            }
            to.length(self.changed_parameters.len());
            for element in &self.changed_parameters {
                Message::write(element, to);
            }
            to.length(self.deleted_parameters.len());
            for element in &self.deleted_parameters {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                stamp: Message::read(from)?,
                node: from.text_of(usize::MAX)?,
                new_parameters: from.list_of(usize::MAX, |from| Message::read(from))?,
                changed_parameters: from
                    .list_of(usize::MAX, |from| Message::read(from))?,
                deleted_parameters: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `rcl_interfaces/msg/ParameterEventDescriptors`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ParameterEventDescriptors {
        pub new_parameters: alloc::vec::Vec<super::rcl_interfaces::ParameterDescriptor>,
        pub changed_parameters: alloc::vec::Vec<
            super::rcl_interfaces::ParameterDescriptor,
        >,
        pub deleted_parameters: alloc::vec::Vec<
            super::rcl_interfaces::ParameterDescriptor,
        >,
    }
    impl Default for ParameterEventDescriptors {
        #[inline]
        fn default() -> Self {
            Self {
                new_parameters: Default::default(),
                changed_parameters: Default::default(),
                deleted_parameters: Default::default(),
            }
        }
    }
    impl Message for ParameterEventDescriptors {
        const NAME: &'static str = "rcl_interfaces/msg/ParameterEventDescriptors";
        const DEFINITION: &'static str = "rcl_interfaces/ParameterDescriptor[] new_parameters\nrcl_interfaces/ParameterDescriptor[] changed_parameters\nrcl_interfaces/ParameterDescriptor[] deleted_parameters\n================================================================================\nMSG: rcl_interfaces/ParameterDescriptor\nstring name\nuint8 type\nstring description\nstring additional_constraints\nbool read_only\nbool dynamic_typing\nrcl_interfaces/FloatingPointRange[<=1] floating_point_range\nrcl_interfaces/IntegerRange[<=1] integer_range\n================================================================================\nMSG: rcl_interfaces/FloatingPointRange\nfloat64 from_value\nfloat64 to_value\nfloat64 step\n================================================================================\nMSG: rcl_interfaces/IntegerRange\nint64 from_value\nint64 to_value\nuint64 step";
        const HASH: &'static str = "RIHS01_456f90915d72ef69379e702ef3ba2a115098ff677eab9c0080fa11239c6b147e";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.new_parameters.len());
            for element in &self.new_parameters {
                Message::write(element, to);
            }
            to.length(self.changed_parameters.len());
            for element in &self.changed_parameters {
                Message::write(element, to);
            }
            to.length(self.deleted_parameters.len());
            for element in &self.deleted_parameters {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                new_parameters: from.list_of(usize::MAX, |from| Message::read(from))?,
                changed_parameters: from
                    .list_of(usize::MAX, |from| Message::read(from))?,
                deleted_parameters: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `rcl_interfaces/msg/ParameterType`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ParameterType {}
    impl ParameterType {
        pub const PARAMETER_NOT_SET: u8 = 0;
        pub const PARAMETER_BOOL: u8 = 1;
        pub const PARAMETER_INTEGER: u8 = 2;
        pub const PARAMETER_DOUBLE: u8 = 3;
        pub const PARAMETER_STRING: u8 = 4;
        pub const PARAMETER_BYTE_ARRAY: u8 = 5;
        pub const PARAMETER_BOOL_ARRAY: u8 = 6;
        pub const PARAMETER_INTEGER_ARRAY: u8 = 7;
        pub const PARAMETER_DOUBLE_ARRAY: u8 = 8;
        pub const PARAMETER_STRING_ARRAY: u8 = 9;
    }
    impl Default for ParameterType {
        #[inline]
        fn default() -> Self {
            Self {}
        }
    }
    impl Message for ParameterType {
        const NAME: &'static str = "rcl_interfaces/msg/ParameterType";
        const DEFINITION: &'static str = "uint8 PARAMETER_NOT_SET=0\nuint8 PARAMETER_BOOL=1\nuint8 PARAMETER_INTEGER=2\nuint8 PARAMETER_DOUBLE=3\nuint8 PARAMETER_STRING=4\nuint8 PARAMETER_BYTE_ARRAY=5\nuint8 PARAMETER_BOOL_ARRAY=6\nuint8 PARAMETER_INTEGER_ARRAY=7\nuint8 PARAMETER_DOUBLE_ARRAY=8\nuint8 PARAMETER_STRING_ARRAY=9";
        const HASH: &'static str = "RIHS01_df29ed057a834862187be24dd187d981790ff3ea6502f4cd27b432cbc42c6d46";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(0_u8);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.empty()?;
            Ok(Self {})
        }
    }
    /// `rcl_interfaces/msg/ParameterValue`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ParameterValue {
        pub r#type: u8,
        pub bool_value: bool,
        pub integer_value: i64,
        pub double_value: f64,
        pub string_value: alloc::string::String,
        pub byte_array_value: alloc::vec::Vec<u8>,
        pub bool_array_value: alloc::vec::Vec<bool>,
        pub integer_array_value: alloc::vec::Vec<i64>,
        pub double_array_value: alloc::vec::Vec<f64>,
        pub string_array_value: alloc::vec::Vec<alloc::string::String>,
    }
    impl Default for ParameterValue {
        #[inline]
        fn default() -> Self {
            Self {
                r#type: Default::default(),
                bool_value: Default::default(),
                integer_value: Default::default(),
                double_value: Default::default(),
                string_value: Default::default(),
                byte_array_value: Default::default(),
                bool_array_value: Default::default(),
                integer_array_value: Default::default(),
                double_array_value: Default::default(),
                string_array_value: Default::default(),
            }
        }
    }
    impl Message for ParameterValue {
        const NAME: &'static str = "rcl_interfaces/msg/ParameterValue";
        const DEFINITION: &'static str = "uint8 type\nbool bool_value\nint64 integer_value\nfloat64 double_value\nstring string_value\nbyte[] byte_array_value\nbool[] bool_array_value\nint64[] integer_array_value\nfloat64[] double_array_value\nstring[] string_array_value";
        const HASH: &'static str = "RIHS01_115fc089a387e23c7ecd3525c9189c379109119d6ab82e8dfbde0fdf6a7f9b68";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.r#type);
            to.number(self.bool_value);
            to.number(self.integer_value);
            to.number(self.double_value);
            to.text(&self.string_value);
            to.length(self.byte_array_value.len());
            to.numbers(&self.byte_array_value);
            to.length(self.bool_array_value.len());
            to.numbers(&self.bool_array_value);
            to.length(self.integer_array_value.len());
            to.numbers(&self.integer_array_value);
            to.length(self.double_array_value.len());
            to.numbers(&self.double_array_value);
            to.length(self.string_array_value.len());
            for element in &self.string_array_value {
                to.text(element);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                r#type: from.number()?,
                bool_value: from.number()?,
                integer_value: from.number()?,
                double_value: from.number()?,
                string_value: from.text_of(usize::MAX)?,
                byte_array_value: from.list(usize::MAX)?,
                bool_array_value: from.list(usize::MAX)?,
                integer_array_value: from.list(usize::MAX)?,
                double_array_value: from.list(usize::MAX)?,
                string_array_value: from
                    .list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
            })
        }
    }
    /// `rcl_interfaces/msg/SetLoggerLevelsResult`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetLoggerLevelsResult {
        pub successful: bool,
        pub reason: alloc::string::String,
    }
    impl Default for SetLoggerLevelsResult {
        #[inline]
        fn default() -> Self {
            Self {
                successful: Default::default(),
                reason: Default::default(),
            }
        }
    }
    impl Message for SetLoggerLevelsResult {
        const NAME: &'static str = "rcl_interfaces/msg/SetLoggerLevelsResult";
        const DEFINITION: &'static str = "bool successful\nstring reason";
        const HASH: &'static str = "RIHS01_9316e5e679a5b72d2dd7fd80c539bae9e106fa0890a06dc5da3a8177a3ff6909";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.successful);
            to.text(&self.reason);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                successful: from.number()?,
                reason: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `rcl_interfaces/msg/SetParametersResult`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetParametersResult {
        pub successful: bool,
        pub reason: alloc::string::String,
    }
    impl Default for SetParametersResult {
        #[inline]
        fn default() -> Self {
            Self {
                successful: Default::default(),
                reason: Default::default(),
            }
        }
    }
    impl Message for SetParametersResult {
        const NAME: &'static str = "rcl_interfaces/msg/SetParametersResult";
        const DEFINITION: &'static str = "bool successful\nstring reason";
        const HASH: &'static str = "RIHS01_cfcc0fb0371ee5159b403960ef4300f8f9d2f1fd6117c8666b7f9654d528a9b1";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.successful);
            to.text(&self.reason);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                successful: from.number()?,
                reason: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `rcl_interfaces/srv/DescribeParameters`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct DescribeParameters;
    impl Service for DescribeParameters {
        const NAME: &'static str = "rcl_interfaces/srv/DescribeParameters";
        const HASH: &'static str = "RIHS01_845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff";
        type Request = super::rcl_interfaces::DescribeParametersRequest;
        type Response = super::rcl_interfaces::DescribeParametersResponse;
    }
    /// `rcl_interfaces/srv/DescribeParameters_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct DescribeParametersRequest {
        pub names: alloc::vec::Vec<alloc::string::String>,
    }
    impl Default for DescribeParametersRequest {
        #[inline]
        fn default() -> Self {
            Self { names: Default::default() }
        }
    }
    impl Message for DescribeParametersRequest {
        const NAME: &'static str = "rcl_interfaces/srv/DescribeParameters_Request";
        const DEFINITION: &'static str = "string[] names";
        const HASH: &'static str = "RIHS01_05dd1c2bc87dec2627105c8070d6f9725c781a4f2ab852975bf105462b82b644";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.names.len());
            for element in &self.names {
                to.text(element);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                names: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
            })
        }
    }
    /// `rcl_interfaces/srv/DescribeParameters_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct DescribeParametersResponse {
        pub descriptors: alloc::vec::Vec<super::rcl_interfaces::ParameterDescriptor>,
    }
    impl Default for DescribeParametersResponse {
        #[inline]
        fn default() -> Self {
            Self {
                descriptors: Default::default(),
            }
        }
    }
    impl Message for DescribeParametersResponse {
        const NAME: &'static str = "rcl_interfaces/srv/DescribeParameters_Response";
        const DEFINITION: &'static str = "rcl_interfaces/ParameterDescriptor[] descriptors\n================================================================================\nMSG: rcl_interfaces/ParameterDescriptor\nstring name\nuint8 type\nstring description\nstring additional_constraints\nbool read_only\nbool dynamic_typing\nrcl_interfaces/FloatingPointRange[<=1] floating_point_range\nrcl_interfaces/IntegerRange[<=1] integer_range\n================================================================================\nMSG: rcl_interfaces/FloatingPointRange\nfloat64 from_value\nfloat64 to_value\nfloat64 step\n================================================================================\nMSG: rcl_interfaces/IntegerRange\nint64 from_value\nint64 to_value\nuint64 step";
        const HASH: &'static str = "RIHS01_ad6747319613c6131589e062e095b469a46cc764f7d0f12a001a49e6cd893995";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.descriptors.len());
            for element in &self.descriptors {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                descriptors: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `rcl_interfaces/srv/GetParameterTypes`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct GetParameterTypes;
    impl Service for GetParameterTypes {
        const NAME: &'static str = "rcl_interfaces/srv/GetParameterTypes";
        const HASH: &'static str = "RIHS01_da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca";
        type Request = super::rcl_interfaces::GetParameterTypesRequest;
        type Response = super::rcl_interfaces::GetParameterTypesResponse;
    }
    /// `rcl_interfaces/srv/GetParameterTypes_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetParameterTypesRequest {
        pub names: alloc::vec::Vec<alloc::string::String>,
    }
    impl Default for GetParameterTypesRequest {
        #[inline]
        fn default() -> Self {
            Self { names: Default::default() }
        }
    }
    impl Message for GetParameterTypesRequest {
        const NAME: &'static str = "rcl_interfaces/srv/GetParameterTypes_Request";
        const DEFINITION: &'static str = "string[] names";
        const HASH: &'static str = "RIHS01_87d7ec5ef545d4daa289d500025d31fb2437bc8b8365ca367161c4dac4be33fd";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.names.len());
            for element in &self.names {
                to.text(element);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                names: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
            })
        }
    }
    /// `rcl_interfaces/srv/GetParameterTypes_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetParameterTypesResponse {
        pub types: alloc::vec::Vec<u8>,
    }
    impl Default for GetParameterTypesResponse {
        #[inline]
        fn default() -> Self {
            Self { types: Default::default() }
        }
    }
    impl Message for GetParameterTypesResponse {
        const NAME: &'static str = "rcl_interfaces/srv/GetParameterTypes_Response";
        const DEFINITION: &'static str = "uint8[] types";
        const HASH: &'static str = "RIHS01_ac1335dce67c478e669434f6ac2fbff34fcd529580f272d3006785ba8b54e47f";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.types.len());
            to.numbers(&self.types);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                types: from.list(usize::MAX)?,
            })
        }
    }
    /// `rcl_interfaces/srv/GetParameters`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct GetParameters;
    impl Service for GetParameters {
        const NAME: &'static str = "rcl_interfaces/srv/GetParameters";
        const HASH: &'static str = "RIHS01_bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc";
        type Request = super::rcl_interfaces::GetParametersRequest;
        type Response = super::rcl_interfaces::GetParametersResponse;
    }
    /// `rcl_interfaces/srv/GetParameters_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetParametersRequest {
        pub names: alloc::vec::Vec<alloc::string::String>,
    }
    impl Default for GetParametersRequest {
        #[inline]
        fn default() -> Self {
            Self { names: Default::default() }
        }
    }
    impl Message for GetParametersRequest {
        const NAME: &'static str = "rcl_interfaces/srv/GetParameters_Request";
        const DEFINITION: &'static str = "string[] names";
        const HASH: &'static str = "RIHS01_135a9e1c3d7cebef792f6687d7ddf99949b21a0bd9a320d863a9110a3f5cf4d6";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.names.len());
            for element in &self.names {
                to.text(element);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                names: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
            })
        }
    }
    /// `rcl_interfaces/srv/GetParameters_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct GetParametersResponse {
        pub values: alloc::vec::Vec<super::rcl_interfaces::ParameterValue>,
    }
    impl Default for GetParametersResponse {
        #[inline]
        fn default() -> Self {
            Self { values: Default::default() }
        }
    }
    impl Message for GetParametersResponse {
        const NAME: &'static str = "rcl_interfaces/srv/GetParameters_Response";
        const DEFINITION: &'static str = "rcl_interfaces/ParameterValue[] values\n================================================================================\nMSG: rcl_interfaces/ParameterValue\nuint8 type\nbool bool_value\nint64 integer_value\nfloat64 double_value\nstring string_value\nbyte[] byte_array_value\nbool[] bool_array_value\nint64[] integer_array_value\nfloat64[] double_array_value\nstring[] string_array_value";
        const HASH: &'static str = "RIHS01_9fa773b46e39cc5d02db6224d8fd520bb9caeeffc2b27c96c1e59431baba9f2a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.values.len());
            for element in &self.values {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                values: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `rcl_interfaces/srv/ListParameters`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct ListParameters;
    impl Service for ListParameters {
        const NAME: &'static str = "rcl_interfaces/srv/ListParameters";
        const HASH: &'static str = "RIHS01_3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d";
        type Request = super::rcl_interfaces::ListParametersRequest;
        type Response = super::rcl_interfaces::ListParametersResponse;
    }
    /// `rcl_interfaces/srv/ListParameters_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ListParametersRequest {
        pub prefixes: alloc::vec::Vec<alloc::string::String>,
        pub depth: u64,
    }
    impl ListParametersRequest {
        pub const DEPTH_RECURSIVE: u64 = 0;
    }
    impl Default for ListParametersRequest {
        #[inline]
        fn default() -> Self {
            Self {
                prefixes: Default::default(),
                depth: Default::default(),
            }
        }
    }
    impl Message for ListParametersRequest {
        const NAME: &'static str = "rcl_interfaces/srv/ListParameters_Request";
        const DEFINITION: &'static str = "uint64 DEPTH_RECURSIVE=0\nstring[] prefixes\nuint64 depth";
        const HASH: &'static str = "RIHS01_a1b0b5d6b967a5b8ac5bc8563c3ea678f349e312a6a4967227c5a96bc5ce38df";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.prefixes.len());
            for element in &self.prefixes {
                to.text(element);
            }
            to.number(self.depth);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                prefixes: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
                depth: from.number()?,
            })
        }
    }
    /// `rcl_interfaces/srv/ListParameters_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ListParametersResponse {
        pub result: super::rcl_interfaces::ListParametersResult,
    }
    impl Default for ListParametersResponse {
        #[inline]
        fn default() -> Self {
            Self { result: Default::default() }
        }
    }
    impl Message for ListParametersResponse {
        const NAME: &'static str = "rcl_interfaces/srv/ListParameters_Response";
        const DEFINITION: &'static str = "rcl_interfaces/ListParametersResult result\n================================================================================\nMSG: rcl_interfaces/ListParametersResult\nstring[] names\nstring[] prefixes";
        const HASH: &'static str = "RIHS01_31b937b82de3612426be79f231e386259f97e8dc843e3f2845288b4bfa296bdd";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.result, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                result: Message::read(from)?,
            })
        }
    }
    /// `rcl_interfaces/srv/SetParameters`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct SetParameters;
    impl Service for SetParameters {
        const NAME: &'static str = "rcl_interfaces/srv/SetParameters";
        const HASH: &'static str = "RIHS01_56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0";
        type Request = super::rcl_interfaces::SetParametersRequest;
        type Response = super::rcl_interfaces::SetParametersResponse;
    }
    /// `rcl_interfaces/srv/SetParametersAtomically`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct SetParametersAtomically;
    impl Service for SetParametersAtomically {
        const NAME: &'static str = "rcl_interfaces/srv/SetParametersAtomically";
        const HASH: &'static str = "RIHS01_0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd";
        type Request = super::rcl_interfaces::SetParametersAtomicallyRequest;
        type Response = super::rcl_interfaces::SetParametersAtomicallyResponse;
    }
    /// `rcl_interfaces/srv/SetParametersAtomically_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetParametersAtomicallyRequest {
        pub parameters: alloc::vec::Vec<super::rcl_interfaces::Parameter>,
    }
    impl Default for SetParametersAtomicallyRequest {
        #[inline]
        fn default() -> Self {
            Self {
                parameters: Default::default(),
            }
        }
    }
    impl Message for SetParametersAtomicallyRequest {
        const NAME: &'static str = "rcl_interfaces/srv/SetParametersAtomically_Request";
        const DEFINITION: &'static str = "rcl_interfaces/Parameter[] parameters\n================================================================================\nMSG: rcl_interfaces/Parameter\nstring name\nrcl_interfaces/ParameterValue value\n================================================================================\nMSG: rcl_interfaces/ParameterValue\nuint8 type\nbool bool_value\nint64 integer_value\nfloat64 double_value\nstring string_value\nbyte[] byte_array_value\nbool[] bool_array_value\nint64[] integer_array_value\nfloat64[] double_array_value\nstring[] string_array_value";
        const HASH: &'static str = "RIHS01_db0bd950ed5ed867a0e90b225e44dea382d762c0762ff3e0ee842190042a59e5";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.parameters.len());
            for element in &self.parameters {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                parameters: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `rcl_interfaces/srv/SetParametersAtomically_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetParametersAtomicallyResponse {
        pub result: super::rcl_interfaces::SetParametersResult,
    }
    impl Default for SetParametersAtomicallyResponse {
        #[inline]
        fn default() -> Self {
            Self { result: Default::default() }
        }
    }
    impl Message for SetParametersAtomicallyResponse {
        const NAME: &'static str = "rcl_interfaces/srv/SetParametersAtomically_Response";
        const DEFINITION: &'static str = "rcl_interfaces/SetParametersResult result\n================================================================================\nMSG: rcl_interfaces/SetParametersResult\nbool successful\nstring reason";
        const HASH: &'static str = "RIHS01_31b1a38c5b0b9d893ee24da45f69638f4561c78461d82d52750f429b534502b8";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.result, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                result: Message::read(from)?,
            })
        }
    }
    /// `rcl_interfaces/srv/SetParameters_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetParametersRequest {
        pub parameters: alloc::vec::Vec<super::rcl_interfaces::Parameter>,
    }
    impl Default for SetParametersRequest {
        #[inline]
        fn default() -> Self {
            Self {
                parameters: Default::default(),
            }
        }
    }
    impl Message for SetParametersRequest {
        const NAME: &'static str = "rcl_interfaces/srv/SetParameters_Request";
        const DEFINITION: &'static str = "rcl_interfaces/Parameter[] parameters\n================================================================================\nMSG: rcl_interfaces/Parameter\nstring name\nrcl_interfaces/ParameterValue value\n================================================================================\nMSG: rcl_interfaces/ParameterValue\nuint8 type\nbool bool_value\nint64 integer_value\nfloat64 double_value\nstring string_value\nbyte[] byte_array_value\nbool[] bool_array_value\nint64[] integer_array_value\nfloat64[] double_array_value\nstring[] string_array_value";
        const HASH: &'static str = "RIHS01_130d46386b7e84ea9ecf60608a4d83cbe5e5cb7c6cc5b712b7a4e3a6c254e932";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.parameters.len());
            for element in &self.parameters {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                parameters: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `rcl_interfaces/srv/SetParameters_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetParametersResponse {
        pub results: alloc::vec::Vec<super::rcl_interfaces::SetParametersResult>,
    }
    impl Default for SetParametersResponse {
        #[inline]
        fn default() -> Self {
            Self {
                results: Default::default(),
            }
        }
    }
    impl Message for SetParametersResponse {
        const NAME: &'static str = "rcl_interfaces/srv/SetParameters_Response";
        const DEFINITION: &'static str = "rcl_interfaces/SetParametersResult[] results\n================================================================================\nMSG: rcl_interfaces/SetParametersResult\nbool successful\nstring reason";
        const HASH: &'static str = "RIHS01_7a0e8140a0b8d98308fa81a5403a766e610af29a239caf54b7553227906fc266";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.results.len());
            for element in &self.results {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                results: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
}
/// Package `rosgraph_msgs`.
pub mod rosgraph_msgs {
    use super::*;
    /// `rosgraph_msgs/msg/Clock`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Clock {
        pub clock: super::builtin_interfaces::Time,
    }
    impl Default for Clock {
        #[inline]
        fn default() -> Self {
            Self { clock: Default::default() }
        }
    }
    impl Message for Clock {
        const NAME: &'static str = "rosgraph_msgs/msg/Clock";
        const DEFINITION: &'static str = "builtin_interfaces/Time clock\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.clock, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                clock: Message::read(from)?,
            })
        }
    }
}
/// Package `sensor_msgs`.
pub mod sensor_msgs {
    use super::*;
    /// `sensor_msgs/msg/BatteryState`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct BatteryState {
        pub header: super::std_msgs::Header,
        pub voltage: f32,
        pub temperature: f32,
        pub current: f32,
        pub charge: f32,
        pub capacity: f32,
        pub design_capacity: f32,
        pub percentage: f32,
        pub power_supply_status: u8,
        pub power_supply_health: u8,
        pub power_supply_technology: u8,
        pub present: bool,
        pub cell_voltage: alloc::vec::Vec<f32>,
        pub cell_temperature: alloc::vec::Vec<f32>,
        pub location: alloc::string::String,
        pub serial_number: alloc::string::String,
    }
    impl BatteryState {
        pub const POWER_SUPPLY_STATUS_UNKNOWN: u8 = 0;
        pub const POWER_SUPPLY_STATUS_CHARGING: u8 = 1;
        pub const POWER_SUPPLY_STATUS_DISCHARGING: u8 = 2;
        pub const POWER_SUPPLY_STATUS_NOT_CHARGING: u8 = 3;
        pub const POWER_SUPPLY_STATUS_FULL: u8 = 4;
        pub const POWER_SUPPLY_HEALTH_UNKNOWN: u8 = 0;
        pub const POWER_SUPPLY_HEALTH_GOOD: u8 = 1;
        pub const POWER_SUPPLY_HEALTH_OVERHEAT: u8 = 2;
        pub const POWER_SUPPLY_HEALTH_DEAD: u8 = 3;
        pub const POWER_SUPPLY_HEALTH_OVERVOLTAGE: u8 = 4;
        pub const POWER_SUPPLY_HEALTH_UNSPEC_FAILURE: u8 = 5;
        pub const POWER_SUPPLY_HEALTH_COLD: u8 = 6;
        pub const POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE: u8 = 7;
        pub const POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE: u8 = 8;
        pub const POWER_SUPPLY_TECHNOLOGY_UNKNOWN: u8 = 0;
        pub const POWER_SUPPLY_TECHNOLOGY_NIMH: u8 = 1;
        pub const POWER_SUPPLY_TECHNOLOGY_LION: u8 = 2;
        pub const POWER_SUPPLY_TECHNOLOGY_LIPO: u8 = 3;
        pub const POWER_SUPPLY_TECHNOLOGY_LIFE: u8 = 4;
        pub const POWER_SUPPLY_TECHNOLOGY_NICD: u8 = 5;
        pub const POWER_SUPPLY_TECHNOLOGY_LIMN: u8 = 6;
        pub const POWER_SUPPLY_TECHNOLOGY_TERNARY: u8 = 7;
        pub const POWER_SUPPLY_TECHNOLOGY_VRLA: u8 = 8;
    }
    impl Default for BatteryState {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                voltage: Default::default(),
                temperature: Default::default(),
                current: Default::default(),
                charge: Default::default(),
                capacity: Default::default(),
                design_capacity: Default::default(),
                percentage: Default::default(),
                power_supply_status: Default::default(),
                power_supply_health: Default::default(),
                power_supply_technology: Default::default(),
                present: Default::default(),
                cell_voltage: Default::default(),
                cell_temperature: Default::default(),
                location: Default::default(),
                serial_number: Default::default(),
            }
        }
    }
    impl Message for BatteryState {
        const NAME: &'static str = "sensor_msgs/msg/BatteryState";
        const DEFINITION: &'static str = "uint8 POWER_SUPPLY_STATUS_UNKNOWN=0\nuint8 POWER_SUPPLY_STATUS_CHARGING=1\nuint8 POWER_SUPPLY_STATUS_DISCHARGING=2\nuint8 POWER_SUPPLY_STATUS_NOT_CHARGING=3\nuint8 POWER_SUPPLY_STATUS_FULL=4\nuint8 POWER_SUPPLY_HEALTH_UNKNOWN=0\nuint8 POWER_SUPPLY_HEALTH_GOOD=1\nuint8 POWER_SUPPLY_HEALTH_OVERHEAT=2\nuint8 POWER_SUPPLY_HEALTH_DEAD=3\nuint8 POWER_SUPPLY_HEALTH_OVERVOLTAGE=4\nuint8 POWER_SUPPLY_HEALTH_UNSPEC_FAILURE=5\nuint8 POWER_SUPPLY_HEALTH_COLD=6\nuint8 POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE=7\nuint8 POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE=8\nuint8 POWER_SUPPLY_TECHNOLOGY_UNKNOWN=0\nuint8 POWER_SUPPLY_TECHNOLOGY_NIMH=1\nuint8 POWER_SUPPLY_TECHNOLOGY_LION=2\nuint8 POWER_SUPPLY_TECHNOLOGY_LIPO=3\nuint8 POWER_SUPPLY_TECHNOLOGY_LIFE=4\nuint8 POWER_SUPPLY_TECHNOLOGY_NICD=5\nuint8 POWER_SUPPLY_TECHNOLOGY_LIMN=6\nuint8 POWER_SUPPLY_TECHNOLOGY_TERNARY=7\nuint8 POWER_SUPPLY_TECHNOLOGY_VRLA=8\nstd_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\nfloat32 charge\nfloat32 capacity\nfloat32 design_capacity\nfloat32 percentage\nuint8 power_supply_status\nuint8 power_supply_health\nuint8 power_supply_technology\nbool present\nfloat32[] cell_voltage\nfloat32[] cell_temperature\nstring location\nstring serial_number\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.voltage);
            to.number(self.temperature);
            to.number(self.current);
            to.number(self.charge);
            to.number(self.capacity);
            to.number(self.design_capacity);
            to.number(self.percentage);
            to.number(self.power_supply_status);
            to.number(self.power_supply_health);
            to.number(self.power_supply_technology);
            to.number(self.present);
            to.length(self.cell_voltage.len());
            to.numbers(&self.cell_voltage);
            to.length(self.cell_temperature.len());
            to.numbers(&self.cell_temperature);
            to.text(&self.location);
            to.text(&self.serial_number);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                voltage: from.number()?,
                temperature: from.number()?,
                current: from.number()?,
                charge: from.number()?,
                capacity: from.number()?,
                design_capacity: from.number()?,
                percentage: from.number()?,
                power_supply_status: from.number()?,
                power_supply_health: from.number()?,
                power_supply_technology: from.number()?,
                present: from.number()?,
                cell_voltage: from.list(usize::MAX)?,
                cell_temperature: from.list(usize::MAX)?,
                location: from.text_of(usize::MAX)?,
                serial_number: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `sensor_msgs/msg/CameraInfo`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct CameraInfo {
        pub header: super::std_msgs::Header,
        pub height: u32,
        pub width: u32,
        pub distortion_model: alloc::string::String,
        pub d: alloc::vec::Vec<f64>,
        pub k: [f64; 9],
        pub r: [f64; 9],
        pub p: [f64; 12],
        pub binning_x: u32,
        pub binning_y: u32,
        pub roi: super::sensor_msgs::RegionOfInterest,
    }
    impl Default for CameraInfo {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                height: Default::default(),
                width: Default::default(),
                distortion_model: Default::default(),
                d: Default::default(),
                k: [0.0; 9],
                r: [0.0; 9],
                p: [0.0; 12],
                binning_x: Default::default(),
                binning_y: Default::default(),
                roi: Default::default(),
            }
        }
    }
    impl Message for CameraInfo {
        const NAME: &'static str = "sensor_msgs/msg/CameraInfo";
        const DEFINITION: &'static str = "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/RegionOfInterest\nuint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify";
        const HASH: &'static str = "RIHS01_b3dfd68ff46c9d56c80fd3bd4ed22c7a4ddce8c8348f2f59c299e73118e7e275";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.height);
            to.number(self.width);
            to.text(&self.distortion_model);
            to.length(self.d.len());
            to.numbers(&self.d);
            to.numbers(&self.k);
            to.numbers(&self.r);
            to.numbers(&self.p);
            to.number(self.binning_x);
            to.number(self.binning_y);
            Message::write(&self.roi, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                height: from.number()?,
                width: from.number()?,
                distortion_model: from.text_of(usize::MAX)?,
                d: from.list(usize::MAX)?,
                k: from.array()?,
                r: from.array()?,
                p: from.array()?,
                binning_x: from.number()?,
                binning_y: from.number()?,
                roi: Message::read(from)?,
            })
        }
    }
    /// `sensor_msgs/msg/ChannelFloat32`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ChannelFloat32 {
        pub name: alloc::string::String,
        pub values: alloc::vec::Vec<f32>,
    }
    impl Default for ChannelFloat32 {
        #[inline]
        fn default() -> Self {
            Self {
                name: Default::default(),
                values: Default::default(),
            }
        }
    }
    impl Message for ChannelFloat32 {
        const NAME: &'static str = "sensor_msgs/msg/ChannelFloat32";
        const DEFINITION: &'static str = "string name\nfloat32[] values";
        const HASH: &'static str = "RIHS01_92665437ddf39346f4ba39ee32e648390605b633cc077d40f4bd4d7b58af6cd4";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.name);
            to.length(self.values.len());
            to.numbers(&self.values);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                name: from.text_of(usize::MAX)?,
                values: from.list(usize::MAX)?,
            })
        }
    }
    /// `sensor_msgs/msg/CompressedImage`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct CompressedImage {
        pub header: super::std_msgs::Header,
        pub format: alloc::string::String,
        pub data: alloc::vec::Vec<u8>,
    }
    impl Default for CompressedImage {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                format: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for CompressedImage {
        const NAME: &'static str = "sensor_msgs/msg/CompressedImage";
        const DEFINITION: &'static str = "std_msgs/Header header\nstring format\nuint8[] data\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.text(&self.format);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                format: from.text_of(usize::MAX)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `sensor_msgs/msg/FluidPressure`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FluidPressure {
        pub header: super::std_msgs::Header,
        pub fluid_pressure: f64,
        pub variance: f64,
    }
    impl Default for FluidPressure {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                fluid_pressure: Default::default(),
                variance: Default::default(),
            }
        }
    }
    impl Message for FluidPressure {
        const NAME: &'static str = "sensor_msgs/msg/FluidPressure";
        const DEFINITION: &'static str = "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_22dfb2b145a0bd5a31a1ac3882a1b32148b51d9b2f3bab250290d66f3595bc32";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.fluid_pressure);
            to.number(self.variance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                fluid_pressure: from.number()?,
                variance: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/Illuminance`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Illuminance {
        pub header: super::std_msgs::Header,
        pub illuminance: f64,
        pub variance: f64,
    }
    impl Default for Illuminance {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                illuminance: Default::default(),
                variance: Default::default(),
            }
        }
    }
    impl Message for Illuminance {
        const NAME: &'static str = "sensor_msgs/msg/Illuminance";
        const DEFINITION: &'static str = "std_msgs/Header header\nfloat64 illuminance\nfloat64 variance\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_b954b25f452fcf81a91c9c2a7e3b3fd85c4c873d452aecb3cfd8fd1da732a22d";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.illuminance);
            to.number(self.variance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                illuminance: from.number()?,
                variance: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/Image`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Image {
        pub header: super::std_msgs::Header,
        pub height: u32,
        pub width: u32,
        pub encoding: alloc::string::String,
        pub is_bigendian: u8,
        pub step: u32,
        pub data: alloc::vec::Vec<u8>,
    }
    impl Default for Image {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                height: Default::default(),
                width: Default::default(),
                encoding: Default::default(),
                is_bigendian: Default::default(),
                step: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for Image {
        const NAME: &'static str = "sensor_msgs/msg/Image";
        const DEFINITION: &'static str = "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.height);
            to.number(self.width);
            to.text(&self.encoding);
            to.number(self.is_bigendian);
            to.number(self.step);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                height: from.number()?,
                width: from.number()?,
                encoding: from.text_of(usize::MAX)?,
                is_bigendian: from.number()?,
                step: from.number()?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `sensor_msgs/msg/Imu`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Imu {
        pub header: super::std_msgs::Header,
        pub orientation: super::geometry_msgs::Quaternion,
        pub orientation_covariance: [f64; 9],
        pub angular_velocity: super::geometry_msgs::Vector3,
        pub angular_velocity_covariance: [f64; 9],
        pub linear_acceleration: super::geometry_msgs::Vector3,
        pub linear_acceleration_covariance: [f64; 9],
    }
    impl Default for Imu {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                orientation: Default::default(),
                orientation_covariance: [0.0; 9],
                angular_velocity: Default::default(),
                angular_velocity_covariance: [0.0; 9],
                linear_acceleration: Default::default(),
                linear_acceleration_covariance: [0.0; 9],
            }
        }
    }
    impl Message for Imu {
        const NAME: &'static str = "sensor_msgs/msg/Imu";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.orientation, to);
            to.numbers(&self.orientation_covariance);
            Message::write(&self.angular_velocity, to);
            to.numbers(&self.angular_velocity_covariance);
            Message::write(&self.linear_acceleration, to);
            to.numbers(&self.linear_acceleration_covariance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                orientation: Message::read(from)?,
                orientation_covariance: from.array()?,
                angular_velocity: Message::read(from)?,
                angular_velocity_covariance: from.array()?,
                linear_acceleration: Message::read(from)?,
                linear_acceleration_covariance: from.array()?,
            })
        }
    }
    /// `sensor_msgs/msg/JointState`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct JointState {
        pub header: super::std_msgs::Header,
        pub name: alloc::vec::Vec<alloc::string::String>,
        pub position: alloc::vec::Vec<f64>,
        pub velocity: alloc::vec::Vec<f64>,
        pub effort: alloc::vec::Vec<f64>,
    }
    impl Default for JointState {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                name: Default::default(),
                position: Default::default(),
                velocity: Default::default(),
                effort: Default::default(),
            }
        }
    }
    impl Message for JointState {
        const NAME: &'static str = "sensor_msgs/msg/JointState";
        const DEFINITION: &'static str = "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.name.len());
            for element in &self.name {
                to.text(element);
            }
            to.length(self.position.len());
            to.numbers(&self.position);
            to.length(self.velocity.len());
            to.numbers(&self.velocity);
            to.length(self.effort.len());
            to.numbers(&self.effort);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                name: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
                position: from.list(usize::MAX)?,
                velocity: from.list(usize::MAX)?,
                effort: from.list(usize::MAX)?,
            })
        }
    }
    /// `sensor_msgs/msg/Joy`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Joy {
        pub header: super::std_msgs::Header,
        pub axes: alloc::vec::Vec<f32>,
        pub buttons: alloc::vec::Vec<i32>,
    }
    impl Default for Joy {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                axes: Default::default(),
                buttons: Default::default(),
            }
        }
    }
    impl Message for Joy {
        const NAME: &'static str = "sensor_msgs/msg/Joy";
        const DEFINITION: &'static str = "std_msgs/Header header\nfloat32[] axes\nint32[] buttons\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_0d356c79cad3401e35ffeb75a96a96e08be3ef896b8b83841d73e890989372c5";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.axes.len());
            to.numbers(&self.axes);
            to.length(self.buttons.len());
            to.numbers(&self.buttons);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                axes: from.list(usize::MAX)?,
                buttons: from.list(usize::MAX)?,
            })
        }
    }
    /// `sensor_msgs/msg/JoyFeedback`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct JoyFeedback {
        pub r#type: u8,
        pub id: u8,
        pub intensity: f32,
    }
    impl JoyFeedback {
        pub const TYPE_LED: u8 = 0;
        pub const TYPE_RUMBLE: u8 = 1;
        pub const TYPE_BUZZER: u8 = 2;
    }
    impl Default for JoyFeedback {
        #[inline]
        fn default() -> Self {
            Self {
                r#type: Default::default(),
                id: Default::default(),
                intensity: Default::default(),
            }
        }
    }
    impl Message for JoyFeedback {
        const NAME: &'static str = "sensor_msgs/msg/JoyFeedback";
        const DEFINITION: &'static str = "uint8 TYPE_LED=0\nuint8 TYPE_RUMBLE=1\nuint8 TYPE_BUZZER=2\nuint8 type\nuint8 id\nfloat32 intensity";
        const HASH: &'static str = "RIHS01_231dd362f71d6fc08272770d07120ad5fe5874ce2dbac70109b28986834290cd";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.r#type);
            to.number(self.id);
            to.number(self.intensity);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                r#type: from.number()?,
                id: from.number()?,
                intensity: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/JoyFeedbackArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct JoyFeedbackArray {
        pub array: alloc::vec::Vec<super::sensor_msgs::JoyFeedback>,
    }
    impl Default for JoyFeedbackArray {
        #[inline]
        fn default() -> Self {
            Self { array: Default::default() }
        }
    }
    impl Message for JoyFeedbackArray {
        const NAME: &'static str = "sensor_msgs/msg/JoyFeedbackArray";
        const DEFINITION: &'static str = "sensor_msgs/JoyFeedback[] array\n================================================================================\nMSG: sensor_msgs/JoyFeedback\nuint8 TYPE_LED=0\nuint8 TYPE_RUMBLE=1\nuint8 TYPE_BUZZER=2\nuint8 type\nuint8 id\nfloat32 intensity";
        const HASH: &'static str = "RIHS01_3287c32e1b688cae04555e465443df3cca7dae76ee4ebf85c4658d585037bcaa";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.array.len());
            for element in &self.array {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                array: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `sensor_msgs/msg/LaserEcho`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct LaserEcho {
        pub echoes: alloc::vec::Vec<f32>,
    }
    impl Default for LaserEcho {
        #[inline]
        fn default() -> Self {
            Self { echoes: Default::default() }
        }
    }
    impl Message for LaserEcho {
        const NAME: &'static str = "sensor_msgs/msg/LaserEcho";
        const DEFINITION: &'static str = "float32[] echoes";
        const HASH: &'static str = "RIHS01_0fbc05a0db7d37fe52c0f0375356db55da0046f7ef5bd27ca6b34bd0582bc952";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.echoes.len());
            to.numbers(&self.echoes);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                echoes: from.list(usize::MAX)?,
            })
        }
    }
    /// `sensor_msgs/msg/LaserScan`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct LaserScan {
        pub header: super::std_msgs::Header,
        pub angle_min: f32,
        pub angle_max: f32,
        pub angle_increment: f32,
        pub time_increment: f32,
        pub scan_time: f32,
        pub range_min: f32,
        pub range_max: f32,
        pub ranges: alloc::vec::Vec<f32>,
        pub intensities: alloc::vec::Vec<f32>,
    }
    impl Default for LaserScan {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                angle_min: Default::default(),
                angle_max: Default::default(),
                angle_increment: Default::default(),
                time_increment: Default::default(),
                scan_time: Default::default(),
                range_min: Default::default(),
                range_max: Default::default(),
                ranges: Default::default(),
                intensities: Default::default(),
            }
        }
    }
    impl Message for LaserScan {
        const NAME: &'static str = "sensor_msgs/msg/LaserScan";
        const DEFINITION: &'static str = "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.angle_min);
            to.number(self.angle_max);
            to.number(self.angle_increment);
            to.number(self.time_increment);
            to.number(self.scan_time);
            to.number(self.range_min);
            to.number(self.range_max);
            to.length(self.ranges.len());
            to.numbers(&self.ranges);
            to.length(self.intensities.len());
            to.numbers(&self.intensities);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                angle_min: from.number()?,
                angle_max: from.number()?,
                angle_increment: from.number()?,
                time_increment: from.number()?,
                scan_time: from.number()?,
                range_min: from.number()?,
                range_max: from.number()?,
                ranges: from.list(usize::MAX)?,
                intensities: from.list(usize::MAX)?,
            })
        }
    }
    /// `sensor_msgs/msg/MagneticField`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MagneticField {
        pub header: super::std_msgs::Header,
        pub magnetic_field: super::geometry_msgs::Vector3,
        pub magnetic_field_covariance: [f64; 9],
    }
    impl Default for MagneticField {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                magnetic_field: Default::default(),
                magnetic_field_covariance: [0.0; 9],
            }
        }
    }
    impl Message for MagneticField {
        const NAME: &'static str = "sensor_msgs/msg/MagneticField";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\nfloat64[9] magnetic_field_covariance\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_e80f32f56a20486c9923008fc1a1db07bbb273cbbf6a5b3bfa00835ee00e4dff";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.magnetic_field, to);
            to.numbers(&self.magnetic_field_covariance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                magnetic_field: Message::read(from)?,
                magnetic_field_covariance: from.array()?,
            })
        }
    }
    /// `sensor_msgs/msg/MultiDOFJointState`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MultiDOFJointState {
        pub header: super::std_msgs::Header,
        pub joint_names: alloc::vec::Vec<alloc::string::String>,
        pub transforms: alloc::vec::Vec<super::geometry_msgs::Transform>,
        pub twist: alloc::vec::Vec<super::geometry_msgs::Twist>,
        pub wrench: alloc::vec::Vec<super::geometry_msgs::Wrench>,
    }
    impl Default for MultiDOFJointState {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                joint_names: Default::default(),
                transforms: Default::default(),
                twist: Default::default(),
                wrench: Default::default(),
            }
        }
    }
    impl Message for MultiDOFJointState {
        const NAME: &'static str = "sensor_msgs/msg/MultiDOFJointState";
        const DEFINITION: &'static str = "std_msgs/Header header\nstring[] joint_names\ngeometry_msgs/Transform[] transforms\ngeometry_msgs/Twist[] twist\ngeometry_msgs/Wrench[] wrench\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque";
        const HASH: &'static str = "RIHS01_4d4ded702cfba7ff3ec783835c1a1425f75e53939a430ff355d1fee4b3bbc40b";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.joint_names.len());
            for element in &self.joint_names {
                to.text(element);
            }
            to.length(self.transforms.len());
            for element in &self.transforms {
                Message::write(element, to);
            }
            to.length(self.twist.len());
            for element in &self.twist {
                Message::write(element, to);
            }
            to.length(self.wrench.len());
            for element in &self.wrench {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                joint_names: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
                transforms: from.list_of(usize::MAX, |from| Message::read(from))?,
                twist: from.list_of(usize::MAX, |from| Message::read(from))?,
                wrench: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `sensor_msgs/msg/MultiEchoLaserScan`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MultiEchoLaserScan {
        pub header: super::std_msgs::Header,
        pub angle_min: f32,
        pub angle_max: f32,
        pub angle_increment: f32,
        pub time_increment: f32,
        pub scan_time: f32,
        pub range_min: f32,
        pub range_max: f32,
        pub ranges: alloc::vec::Vec<super::sensor_msgs::LaserEcho>,
        pub intensities: alloc::vec::Vec<super::sensor_msgs::LaserEcho>,
    }
    impl Default for MultiEchoLaserScan {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                angle_min: Default::default(),
                angle_max: Default::default(),
                angle_increment: Default::default(),
                time_increment: Default::default(),
                scan_time: Default::default(),
                range_min: Default::default(),
                range_max: Default::default(),
                ranges: Default::default(),
                intensities: Default::default(),
            }
        }
    }
    impl Message for MultiEchoLaserScan {
        const NAME: &'static str = "sensor_msgs/msg/MultiEchoLaserScan";
        const DEFINITION: &'static str = "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nsensor_msgs/LaserEcho[] ranges\nsensor_msgs/LaserEcho[] intensities\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/LaserEcho\nfloat32[] echoes";
        const HASH: &'static str = "RIHS01_ba5eac341cd5bbb2701527aa4568e8baec172b69cadb9a1945d6f149d087ee48";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.angle_min);
            to.number(self.angle_max);
            to.number(self.angle_increment);
            to.number(self.time_increment);
            to.number(self.scan_time);
            to.number(self.range_min);
            to.number(self.range_max);
            to.length(self.ranges.len());
            for element in &self.ranges {
                Message::write(element, to);
            }
            to.length(self.intensities.len());
            for element in &self.intensities {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                angle_min: from.number()?,
                angle_max: from.number()?,
                angle_increment: from.number()?,
                time_increment: from.number()?,
                scan_time: from.number()?,
                range_min: from.number()?,
                range_max: from.number()?,
                ranges: from.list_of(usize::MAX, |from| Message::read(from))?,
                intensities: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `sensor_msgs/msg/NavSatFix`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct NavSatFix {
        pub header: super::std_msgs::Header,
        pub status: super::sensor_msgs::NavSatStatus,
        pub latitude: f64,
        pub longitude: f64,
        pub altitude: f64,
        pub position_covariance: [f64; 9],
        pub position_covariance_type: u8,
    }
    impl NavSatFix {
        pub const COVARIANCE_TYPE_UNKNOWN: u8 = 0;
        pub const COVARIANCE_TYPE_APPROXIMATED: u8 = 1;
        pub const COVARIANCE_TYPE_DIAGONAL_KNOWN: u8 = 2;
        pub const COVARIANCE_TYPE_KNOWN: u8 = 3;
    }
    impl Default for NavSatFix {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                status: Default::default(),
                latitude: Default::default(),
                longitude: Default::default(),
                altitude: Default::default(),
                position_covariance: [0.0; 9],
                position_covariance_type: Default::default(),
            }
        }
    }
    impl Message for NavSatFix {
        const NAME: &'static str = "sensor_msgs/msg/NavSatFix";
        const DEFINITION: &'static str = "uint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 COVARIANCE_TYPE_APPROXIMATED=1\nuint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 COVARIANCE_TYPE_KNOWN=3\nstd_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 altitude\nfloat64[9] position_covariance\nuint8 position_covariance_type\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/NavSatStatus\nint8 STATUS_UNKNOWN=-2\nint8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\nuint16 SERVICE_UNKNOWN=0\nuint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\nuint16 SERVICE_GALILEO=8\nint8 status\nuint16 service";
        const HASH: &'static str = "RIHS01_62223ab3fe210a15976021da7afddc9e200dc9ec75231c1b6a557fc598a65404";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.status, to);
            to.number(self.latitude);
            to.number(self.longitude);
            to.number(self.altitude);
            to.numbers(&self.position_covariance);
            to.number(self.position_covariance_type);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                status: Message::read(from)?,
                latitude: from.number()?,
                longitude: from.number()?,
                altitude: from.number()?,
                position_covariance: from.array()?,
                position_covariance_type: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/NavSatStatus`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct NavSatStatus {
        pub status: i8,
        pub service: u16,
    }
    impl NavSatStatus {
        pub const STATUS_UNKNOWN: i8 = -2;
        pub const STATUS_NO_FIX: i8 = -1;
        pub const STATUS_FIX: i8 = 0;
        pub const STATUS_SBAS_FIX: i8 = 1;
        pub const STATUS_GBAS_FIX: i8 = 2;
        pub const SERVICE_UNKNOWN: u16 = 0;
        pub const SERVICE_GPS: u16 = 1;
        pub const SERVICE_GLONASS: u16 = 2;
        pub const SERVICE_COMPASS: u16 = 4;
        pub const SERVICE_GALILEO: u16 = 8;
    }
    impl Default for NavSatStatus {
        #[inline]
        fn default() -> Self {
            Self {
                status: Default::default(),
                service: Default::default(),
            }
        }
    }
    impl Message for NavSatStatus {
        const NAME: &'static str = "sensor_msgs/msg/NavSatStatus";
        const DEFINITION: &'static str = "int8 STATUS_UNKNOWN=-2\nint8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\nuint16 SERVICE_UNKNOWN=0\nuint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\nuint16 SERVICE_GALILEO=8\nint8 status\nuint16 service";
        const HASH: &'static str = "RIHS01_d1ed3befa628e09571bd273b888ba1c1fd187c9a5e0006b385d7e5e9095a3204";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.status);
            to.number(self.service);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                status: from.number()?,
                service: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/PointCloud`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PointCloud {
        pub header: super::std_msgs::Header,
        pub points: alloc::vec::Vec<super::geometry_msgs::Point32>,
        pub channels: alloc::vec::Vec<super::sensor_msgs::ChannelFloat32>,
    }
    impl Default for PointCloud {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                points: Default::default(),
                channels: Default::default(),
            }
        }
    }
    impl Message for PointCloud {
        const NAME: &'static str = "sensor_msgs/msg/PointCloud";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Point32[] points\nsensor_msgs/ChannelFloat32[] channels\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Point32\nfloat32 x\nfloat32 y\nfloat32 z\n================================================================================\nMSG: sensor_msgs/ChannelFloat32\nstring name\nfloat32[] values";
        const HASH: &'static str = "RIHS01_614593df71d3c2b9bd4604a71b750fd218f0d65c045ea988b713719455a65b3b";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.points.len());
            for element in &self.points {
                Message::write(element, to);
            }
            to.length(self.channels.len());
            for element in &self.channels {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                points: from.list_of(usize::MAX, |from| Message::read(from))?,
                channels: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `sensor_msgs/msg/PointCloud2`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PointCloud2 {
        pub header: super::std_msgs::Header,
        pub height: u32,
        pub width: u32,
        pub fields: alloc::vec::Vec<super::sensor_msgs::PointField>,
        pub is_bigendian: bool,
        pub point_step: u32,
        pub row_step: u32,
        pub data: alloc::vec::Vec<u8>,
        pub is_dense: bool,
    }
    impl Default for PointCloud2 {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                height: Default::default(),
                width: Default::default(),
                fields: Default::default(),
                is_bigendian: Default::default(),
                point_step: Default::default(),
                row_step: Default::default(),
                data: Default::default(),
                is_dense: Default::default(),
            }
        }
    }
    impl Message for PointCloud2 {
        const NAME: &'static str = "sensor_msgs/msg/PointCloud2";
        const DEFINITION: &'static str = "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/PointField\nuint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count";
        const HASH: &'static str = "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.height);
            to.number(self.width);
            to.length(self.fields.len());
            for element in &self.fields {
                Message::write(element, to);
            }
            to.number(self.is_bigendian);
            to.number(self.point_step);
            to.number(self.row_step);
            to.length(self.data.len());
            to.numbers(&self.data);
            to.number(self.is_dense);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                height: from.number()?,
                width: from.number()?,
                fields: from.list_of(usize::MAX, |from| Message::read(from))?,
                is_bigendian: from.number()?,
                point_step: from.number()?,
                row_step: from.number()?,
                data: from.list(usize::MAX)?,
                is_dense: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/PointField`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PointField {
        pub name: alloc::string::String,
        pub offset: u32,
        pub datatype: u8,
        pub count: u32,
    }
    impl PointField {
        pub const INT8: u8 = 1;
        pub const UINT8: u8 = 2;
        pub const INT16: u8 = 3;
        pub const UINT16: u8 = 4;
        pub const INT32: u8 = 5;
        pub const UINT32: u8 = 6;
        pub const FLOAT32: u8 = 7;
        pub const FLOAT64: u8 = 8;
    }
    impl Default for PointField {
        #[inline]
        fn default() -> Self {
            Self {
                name: Default::default(),
                offset: Default::default(),
                datatype: Default::default(),
                count: Default::default(),
            }
        }
    }
    impl Message for PointField {
        const NAME: &'static str = "sensor_msgs/msg/PointField";
        const DEFINITION: &'static str = "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count";
        const HASH: &'static str = "RIHS01_5c6a4750728c2bcfbbf7037225b20b02d4429634732146b742dee1726637ef01";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.name);
            to.number(self.offset);
            to.number(self.datatype);
            to.number(self.count);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                name: from.text_of(usize::MAX)?,
                offset: from.number()?,
                datatype: from.number()?,
                count: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/Range`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Range {
        pub header: super::std_msgs::Header,
        pub radiation_type: u8,
        pub field_of_view: f32,
        pub min_range: f32,
        pub max_range: f32,
        pub range: f32,
        pub variance: f32,
    }
    impl Range {
        pub const ULTRASOUND: u8 = 0;
        pub const INFRARED: u8 = 1;
    }
    impl Default for Range {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                radiation_type: Default::default(),
                field_of_view: Default::default(),
                min_range: Default::default(),
                max_range: Default::default(),
                range: Default::default(),
                variance: Default::default(),
            }
        }
    }
    impl Message for Range {
        const NAME: &'static str = "sensor_msgs/msg/Range";
        const DEFINITION: &'static str = "uint8 ULTRASOUND=0\nuint8 INFRARED=1\nstd_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\nfloat32 variance\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.radiation_type);
            to.number(self.field_of_view);
            to.number(self.min_range);
            to.number(self.max_range);
            to.number(self.range);
            to.number(self.variance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                radiation_type: from.number()?,
                field_of_view: from.number()?,
                min_range: from.number()?,
                max_range: from.number()?,
                range: from.number()?,
                variance: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/RegionOfInterest`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RegionOfInterest {
        pub x_offset: u32,
        pub y_offset: u32,
        pub height: u32,
        pub width: u32,
        pub do_rectify: bool,
    }
    impl Default for RegionOfInterest {
        #[inline]
        fn default() -> Self {
            Self {
                x_offset: Default::default(),
                y_offset: Default::default(),
                height: Default::default(),
                width: Default::default(),
                do_rectify: Default::default(),
            }
        }
    }
    impl Message for RegionOfInterest {
        const NAME: &'static str = "sensor_msgs/msg/RegionOfInterest";
        const DEFINITION: &'static str = "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify";
        const HASH: &'static str = "RIHS01_ad16bcba5f9131dcdba6fbded19f726f5440e3c513b4fb586dd3027eeed8abb1";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.x_offset);
            to.number(self.y_offset);
            to.number(self.height);
            to.number(self.width);
            to.number(self.do_rectify);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                x_offset: from.number()?,
                y_offset: from.number()?,
                height: from.number()?,
                width: from.number()?,
                do_rectify: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/RelativeHumidity`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RelativeHumidity {
        pub header: super::std_msgs::Header,
        pub relative_humidity: f64,
        pub variance: f64,
    }
    impl Default for RelativeHumidity {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                relative_humidity: Default::default(),
                variance: Default::default(),
            }
        }
    }
    impl Message for RelativeHumidity {
        const NAME: &'static str = "sensor_msgs/msg/RelativeHumidity";
        const DEFINITION: &'static str = "std_msgs/Header header\nfloat64 relative_humidity\nfloat64 variance\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_8687c99b4fb393cb2e545e407b5ea7fd0b5d8960bcd849a0f86c544740138839";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.relative_humidity);
            to.number(self.variance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                relative_humidity: from.number()?,
                variance: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/Temperature`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Temperature {
        pub header: super::std_msgs::Header,
        pub temperature: f64,
        pub variance: f64,
    }
    impl Default for Temperature {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                temperature: Default::default(),
                variance: Default::default(),
            }
        }
    }
    impl Message for Temperature {
        const NAME: &'static str = "sensor_msgs/msg/Temperature";
        const DEFINITION: &'static str = "std_msgs/Header header\nfloat64 temperature\nfloat64 variance\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_72514a14126ab9f8a9abec974c78e5610a367b59db5da355ff1fb982d5bad4b8";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.number(self.temperature);
            to.number(self.variance);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                temperature: from.number()?,
                variance: from.number()?,
            })
        }
    }
    /// `sensor_msgs/msg/TimeReference`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TimeReference {
        pub header: super::std_msgs::Header,
        pub time_ref: super::builtin_interfaces::Time,
        pub source: alloc::string::String,
    }
    impl Default for TimeReference {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                time_ref: Default::default(),
                source: Default::default(),
            }
        }
    }
    impl Message for TimeReference {
        const NAME: &'static str = "sensor_msgs/msg/TimeReference";
        const DEFINITION: &'static str = "std_msgs/Header header\nbuiltin_interfaces/Time time_ref\nstring source\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_dd66e84cf40bbb5d5a40472e6ecf2675a031334d4c426abdb2ad41801a8efc99";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.time_ref, to);
            to.text(&self.source);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                time_ref: Message::read(from)?,
                source: from.text_of(usize::MAX)?,
            })
        }
    }
}
/// Package `service_msgs`.
pub mod service_msgs {
    use super::*;
    /// `service_msgs/msg/ServiceEventInfo`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ServiceEventInfo {
        pub event_type: u8,
        pub stamp: super::builtin_interfaces::Time,
        pub client_gid: [u8; 16],
        pub sequence_number: i64,
    }
    impl ServiceEventInfo {
        pub const REQUEST_SENT: u8 = 0;
        pub const REQUEST_RECEIVED: u8 = 1;
        pub const RESPONSE_SENT: u8 = 2;
        pub const RESPONSE_RECEIVED: u8 = 3;
    }
    impl Default for ServiceEventInfo {
        #[inline]
        fn default() -> Self {
            Self {
                event_type: Default::default(),
                stamp: Default::default(),
                client_gid: [0; 16],
                sequence_number: Default::default(),
            }
        }
    }
    impl Message for ServiceEventInfo {
        const NAME: &'static str = "service_msgs/msg/ServiceEventInfo";
        const DEFINITION: &'static str = "uint8 REQUEST_SENT=0\nuint8 REQUEST_RECEIVED=1\nuint8 RESPONSE_SENT=2\nuint8 RESPONSE_RECEIVED=3\nuint8 event_type\nbuiltin_interfaces/Time stamp\nuint8[16] client_gid\nint64 sequence_number\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_41bcbbe07a75c9b52bc96bfd5c24d7f0fc0a08c0cb7921b3373c5732345a6f45";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.event_type);
            Message::write(&self.stamp, to);
            to.numbers(&self.client_gid);
            to.number(self.sequence_number);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                event_type: from.number()?,
                stamp: Message::read(from)?,
                client_gid: from.array()?,
                sequence_number: from.number()?,
            })
        }
    }
}
/// Package `shape_msgs`.
pub mod shape_msgs {
    use super::*;
    /// `shape_msgs/msg/Mesh`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Mesh {
        pub triangles: alloc::vec::Vec<super::shape_msgs::MeshTriangle>,
        pub vertices: alloc::vec::Vec<super::geometry_msgs::Point>,
    }
    impl Default for Mesh {
        #[inline]
        fn default() -> Self {
            Self {
                triangles: Default::default(),
                vertices: Default::default(),
            }
        }
    }
    impl Message for Mesh {
        const NAME: &'static str = "shape_msgs/msg/Mesh";
        const DEFINITION: &'static str = "shape_msgs/MeshTriangle[] triangles\ngeometry_msgs/Point[] vertices\n================================================================================\nMSG: shape_msgs/MeshTriangle\nuint32[3] vertex_indices\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z";
        const HASH: &'static str = "RIHS01_f2150b82d8ee7e8bc3f396a2b158aefb4b9a5510a474be271ba1268aebb55289";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.triangles.len());
            for element in &self.triangles {
                Message::write(element, to);
            }
            to.length(self.vertices.len());
            for element in &self.vertices {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                triangles: from.list_of(usize::MAX, |from| Message::read(from))?,
                vertices: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `shape_msgs/msg/MeshTriangle`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MeshTriangle {
        pub vertex_indices: [u32; 3],
    }
    impl Default for MeshTriangle {
        #[inline]
        fn default() -> Self {
            Self { vertex_indices: [0; 3] }
        }
    }
    impl Message for MeshTriangle {
        const NAME: &'static str = "shape_msgs/msg/MeshTriangle";
        const DEFINITION: &'static str = "uint32[3] vertex_indices";
        const HASH: &'static str = "RIHS01_618e5c073eeb729e433ef6226e72c01d995c459fb7d76348c9700409a5020bd0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.numbers(&self.vertex_indices);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                vertex_indices: from.array()?,
            })
        }
    }
    /// `shape_msgs/msg/Plane`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Plane {
        pub coef: [f64; 4],
    }
    impl Default for Plane {
        #[inline]
        fn default() -> Self {
            Self { coef: [0.0; 4] }
        }
    }
    impl Message for Plane {
        const NAME: &'static str = "shape_msgs/msg/Plane";
        const DEFINITION: &'static str = "float64[4] coef";
        const HASH: &'static str = "RIHS01_dfbfe8314689c850615d4a727af017e9aa86c10e369a606c8c851ef8f16c58c8";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.numbers(&self.coef);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { coef: from.array()? })
        }
    }
    /// `shape_msgs/msg/SolidPrimitive`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SolidPrimitive {
        pub r#type: u8,
        pub dimensions: alloc::vec::Vec<f64>,
        pub polygon: super::geometry_msgs::Polygon,
    }
    impl SolidPrimitive {
        pub const BOX: u8 = 1;
        pub const SPHERE: u8 = 2;
        pub const CYLINDER: u8 = 3;
        pub const CONE: u8 = 4;
        pub const PRISM: u8 = 5;
        pub const BOX_X: u8 = 0;
        pub const BOX_Y: u8 = 1;
        pub const BOX_Z: u8 = 2;
        pub const SPHERE_RADIUS: u8 = 0;
        pub const CYLINDER_HEIGHT: u8 = 0;
        pub const CYLINDER_RADIUS: u8 = 1;
        pub const CONE_HEIGHT: u8 = 0;
        pub const CONE_RADIUS: u8 = 1;
        pub const PRISM_HEIGHT: u8 = 0;
    }
    impl Default for SolidPrimitive {
        #[inline]
        fn default() -> Self {
            Self {
                r#type: Default::default(),
                dimensions: Default::default(),
                polygon: Default::default(),
            }
        }
    }
    impl Message for SolidPrimitive {
        const NAME: &'static str = "shape_msgs/msg/SolidPrimitive";
        const DEFINITION: &'static str = "uint8 BOX=1\nuint8 SPHERE=2\nuint8 CYLINDER=3\nuint8 CONE=4\nuint8 PRISM=5\nuint8 BOX_X=0\nuint8 BOX_Y=1\nuint8 BOX_Z=2\nuint8 SPHERE_RADIUS=0\nuint8 CYLINDER_HEIGHT=0\nuint8 CYLINDER_RADIUS=1\nuint8 CONE_HEIGHT=0\nuint8 CONE_RADIUS=1\nuint8 PRISM_HEIGHT=0\nuint8 type\nfloat64[<=3] dimensions\ngeometry_msgs/Polygon polygon\n================================================================================\nMSG: geometry_msgs/Polygon\ngeometry_msgs/Point32[] points\n================================================================================\nMSG: geometry_msgs/Point32\nfloat32 x\nfloat32 y\nfloat32 z";
        const HASH: &'static str = "RIHS01_2802a15190aadc3f496584df4b0b4c5824d8a0b31aaef839faa75bc34dda38ac";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.r#type);
            to.length(self.dimensions.len());
            to.numbers(&self.dimensions);
            Message::write(&self.polygon, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                r#type: from.number()?,
                dimensions: from.list(3)?,
                polygon: Message::read(from)?,
            })
        }
    }
}
/// Package `std_msgs`.
pub mod std_msgs {
    use super::*;
    /// `std_msgs/msg/Bool`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Bool {
        pub data: bool,
    }
    impl Default for Bool {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for Bool {
        const NAME: &'static str = "std_msgs/msg/Bool";
        const DEFINITION: &'static str = "bool data";
        const HASH: &'static str = "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/Byte`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Byte {
        pub data: u8,
    }
    impl Default for Byte {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for Byte {
        const NAME: &'static str = "std_msgs/msg/Byte";
        const DEFINITION: &'static str = "byte data";
        const HASH: &'static str = "RIHS01_41e1a3345f73fe93ede006da826a6ee274af23dd4653976ff249b0f44e3e798f";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/ByteMultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ByteMultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<u8>,
    }
    impl Default for ByteMultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for ByteMultiArray {
        const NAME: &'static str = "std_msgs/msg/ByteMultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nbyte[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_972fec7f50ab3c1d06783c228e79e8a9a509021708c511c059926261ada901d4";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/Char`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Char {
        pub data: u8,
    }
    impl Default for Char {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for Char {
        const NAME: &'static str = "std_msgs/msg/Char";
        const DEFINITION: &'static str = "uint8 data";
        const HASH: &'static str = "RIHS01_3ad2d04dd29ba19d04b16659afa3ccaedd691914b02a64e82e252f2fa6a586a9";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/ColorRGBA`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ColorRGBA {
        pub r: f32,
        pub g: f32,
        pub b: f32,
        pub a: f32,
    }
    impl Default for ColorRGBA {
        #[inline]
        fn default() -> Self {
            Self {
                r: Default::default(),
                g: Default::default(),
                b: Default::default(),
                a: Default::default(),
            }
        }
    }
    impl Message for ColorRGBA {
        const NAME: &'static str = "std_msgs/msg/ColorRGBA";
        const DEFINITION: &'static str = "float32 r\nfloat32 g\nfloat32 b\nfloat32 a";
        const HASH: &'static str = "RIHS01_77a7a5b9ae477306097665106e0413ba74440245b1f3d0c6d6405fe5c7813fe8";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.r);
            to.number(self.g);
            to.number(self.b);
            to.number(self.a);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                r: from.number()?,
                g: from.number()?,
                b: from.number()?,
                a: from.number()?,
            })
        }
    }
    /// `std_msgs/msg/Empty`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Empty {}
    impl Default for Empty {
        #[inline]
        fn default() -> Self {
            Self {}
        }
    }
    impl Message for Empty {
        const NAME: &'static str = "std_msgs/msg/Empty";
        const DEFINITION: &'static str = "";
        const HASH: &'static str = "RIHS01_20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(0_u8);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.empty()?;
            Ok(Self {})
        }
    }
    /// `std_msgs/msg/Float32`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Float32 {
        pub data: f32,
    }
    impl Default for Float32 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for Float32 {
        const NAME: &'static str = "std_msgs/msg/Float32";
        const DEFINITION: &'static str = "float32 data";
        const HASH: &'static str = "RIHS01_7170d3d8f841f7be3172ce5f4f59f3a4d7f63b0447e8b33327601ad64d83d6e2";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/Float32MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Float32MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<f32>,
    }
    impl Default for Float32MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for Float32MultiArray {
        const NAME: &'static str = "std_msgs/msg/Float32MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nfloat32[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_0599f6f85b4bfca379873a0b4375a0aca022156bd2d7021275d116ed1fa8bfe0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/Float64`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Float64 {
        pub data: f64,
    }
    impl Default for Float64 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for Float64 {
        const NAME: &'static str = "std_msgs/msg/Float64";
        const DEFINITION: &'static str = "float64 data";
        const HASH: &'static str = "RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/Float64MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Float64MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<f64>,
    }
    impl Default for Float64MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for Float64MultiArray {
        const NAME: &'static str = "std_msgs/msg/Float64MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nfloat64[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_1025ddc6b9552d191f89ef1a8d2f60f3d373e28b283d8891ddcc974e8c55397f";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/Header`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Header {
        pub stamp: super::builtin_interfaces::Time,
        pub frame_id: alloc::string::String,
    }
    impl Default for Header {
        #[inline]
        fn default() -> Self {
            Self {
                stamp: Default::default(),
                frame_id: Default::default(),
            }
        }
    }
    impl Message for Header {
        const NAME: &'static str = "std_msgs/msg/Header";
        const DEFINITION: &'static str = "builtin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            let header = to.outgoing(self);
            Message::write(&header.stamp, to);
            to.text(&header.frame_id);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.number_of_header()?;
            let header = Self {
                stamp: Message::read(from)?,
                frame_id: from.text_of(usize::MAX)?,
            };
            Ok(from.incoming(header))
        }
    }
    /// `std_msgs/msg/Int16`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Int16 {
        pub data: i16,
    }
    impl Default for Int16 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for Int16 {
        const NAME: &'static str = "std_msgs/msg/Int16";
        const DEFINITION: &'static str = "int16 data";
        const HASH: &'static str = "RIHS01_1dcc3464e47c288a55f943a389d337cdb06804de3f5cd7a266b0de718eee17e5";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/Int16MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Int16MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<i16>,
    }
    impl Default for Int16MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for Int16MultiArray {
        const NAME: &'static str = "std_msgs/msg/Int16MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nint16[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_b58810e8e5b90fb19a5062469eb8409f5ab11a446d60de7157a1457e52a076ce";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/Int32`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Int32 {
        pub data: i32,
    }
    impl Default for Int32 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for Int32 {
        const NAME: &'static str = "std_msgs/msg/Int32";
        const DEFINITION: &'static str = "int32 data";
        const HASH: &'static str = "RIHS01_b6578ded3c58c626cfe8d1a6fb6e04f706f97e9f03d2727c9ff4e74b1cef0deb";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/Int32MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Int32MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<i32>,
    }
    impl Default for Int32MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for Int32MultiArray {
        const NAME: &'static str = "std_msgs/msg/Int32MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nint32[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_84a7346323525d1b4dfca899df3820f245e54009dac5a6b69217d14fdefd1701";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/Int64`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Int64 {
        pub data: i64,
    }
    impl Default for Int64 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for Int64 {
        const NAME: &'static str = "std_msgs/msg/Int64";
        const DEFINITION: &'static str = "int64 data";
        const HASH: &'static str = "RIHS01_8cd1048c2f186b6bd9a92472dc1ce51723c0833a221e2b7aecfff111774f4b49";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/Int64MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Int64MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<i64>,
    }
    impl Default for Int64MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for Int64MultiArray {
        const NAME: &'static str = "std_msgs/msg/Int64MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nint64[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_e60f9fe34d697f0939ad49d33158693c1277fbac0e2f04b7c2995dc21c89b422";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/Int8`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Int8 {
        pub data: i8,
    }
    impl Default for Int8 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for Int8 {
        const NAME: &'static str = "std_msgs/msg/Int8";
        const DEFINITION: &'static str = "int8 data";
        const HASH: &'static str = "RIHS01_26525065a403d972cb672f0777e333f0c799ad444ae5fcd79e43d1e73bd0f440";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/Int8MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Int8MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<i8>,
    }
    impl Default for Int8MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for Int8MultiArray {
        const NAME: &'static str = "std_msgs/msg/Int8MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nint8[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_f21998d4b492abd63330765d75d5831238d400740386f651f13a872a4d2188db";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/MultiArrayDimension`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MultiArrayDimension {
        pub label: alloc::string::String,
        pub size: u32,
        pub stride: u32,
    }
    impl Default for MultiArrayDimension {
        #[inline]
        fn default() -> Self {
            Self {
                label: Default::default(),
                size: Default::default(),
                stride: Default::default(),
            }
        }
    }
    impl Message for MultiArrayDimension {
        const NAME: &'static str = "std_msgs/msg/MultiArrayDimension";
        const DEFINITION: &'static str = "string label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_5e773a60a4c7fc8a54985f307c7837aa2994252a126c301957a24e31282c9cbe";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.label);
            to.number(self.size);
            to.number(self.stride);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                label: from.text_of(usize::MAX)?,
                size: from.number()?,
                stride: from.number()?,
            })
        }
    }
    /// `std_msgs/msg/MultiArrayLayout`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MultiArrayLayout {
        pub dim: alloc::vec::Vec<super::std_msgs::MultiArrayDimension>,
        pub data_offset: u32,
    }
    impl Default for MultiArrayLayout {
        #[inline]
        fn default() -> Self {
            Self {
                dim: Default::default(),
                data_offset: Default::default(),
            }
        }
    }
    impl Message for MultiArrayLayout {
        const NAME: &'static str = "std_msgs/msg/MultiArrayLayout";
        const DEFINITION: &'static str = "std_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_4c66e6f78e740ac103a94cf63259f968e48c617e7699e829b63c21a5cb50dac6";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.dim.len());
            for element in &self.dim {
                Message::write(element, to);
            }
            to.number(self.data_offset);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                dim: from.list_of(usize::MAX, |from| Message::read(from))?,
                data_offset: from.number()?,
            })
        }
    }
    /// `std_msgs/msg/String`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct String {
        pub data: alloc::string::String,
    }
    impl Default for String {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for String {
        const NAME: &'static str = "std_msgs/msg/String";
        const DEFINITION: &'static str = "string data";
        const HASH: &'static str = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                data: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/UInt16`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UInt16 {
        pub data: u16,
    }
    impl Default for UInt16 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for UInt16 {
        const NAME: &'static str = "std_msgs/msg/UInt16";
        const DEFINITION: &'static str = "uint16 data";
        const HASH: &'static str = "RIHS01_08a406e4b022bc22e907f985d6a9e9dd1d4fbecae573549cf49350113e7757b1";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/UInt16MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UInt16MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<u16>,
    }
    impl Default for UInt16MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for UInt16MultiArray {
        const NAME: &'static str = "std_msgs/msg/UInt16MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nuint16[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_94fe73428ec63baecc774f8fb82406123e9291cf728f1b7c91caf5335129492b";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/UInt32`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UInt32 {
        pub data: u32,
    }
    impl Default for UInt32 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for UInt32 {
        const NAME: &'static str = "std_msgs/msg/UInt32";
        const DEFINITION: &'static str = "uint32 data";
        const HASH: &'static str = "RIHS01_a5c874829b752bc5fa190024b0ad76f578cc278271e855c7d02a818b3516fb4a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/UInt32MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UInt32MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<u32>,
    }
    impl Default for UInt32MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for UInt32MultiArray {
        const NAME: &'static str = "std_msgs/msg/UInt32MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nuint32[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_6c2577c7ad3cbdcc2164a41c12f1d5ad314ea320f3fb1ee47e78019fe16bb5b0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/UInt64`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UInt64 {
        pub data: u64,
    }
    impl Default for UInt64 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for UInt64 {
        const NAME: &'static str = "std_msgs/msg/UInt64";
        const DEFINITION: &'static str = "uint64 data";
        const HASH: &'static str = "RIHS01_fbdc52018fc13755dce18024d1a671c856aa8b4aaf63adfb095b608f98e8c943";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/UInt64MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UInt64MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<u64>,
    }
    impl Default for UInt64MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for UInt64MultiArray {
        const NAME: &'static str = "std_msgs/msg/UInt64MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nuint64[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_fc1c685c2f76bdc6983da025cb25d2db5fb5157b059e300f6d957d86f981b366";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `std_msgs/msg/UInt8`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UInt8 {
        pub data: u8,
    }
    impl Default for UInt8 {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for UInt8 {
        const NAME: &'static str = "std_msgs/msg/UInt8";
        const DEFINITION: &'static str = "uint8 data";
        const HASH: &'static str = "RIHS01_6138bd83d8c3569cb80a667db03cfc1629f529fee79d944c39c34e352e72f010";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_msgs/msg/UInt8MultiArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UInt8MultiArray {
        pub layout: super::std_msgs::MultiArrayLayout,
        pub data: alloc::vec::Vec<u8>,
    }
    impl Default for UInt8MultiArray {
        #[inline]
        fn default() -> Self {
            Self {
                layout: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for UInt8MultiArray {
        const NAME: &'static str = "std_msgs/msg/UInt8MultiArray";
        const DEFINITION: &'static str = "std_msgs/MultiArrayLayout layout\nuint8[] data\n================================================================================\nMSG: std_msgs/MultiArrayLayout\nstd_msgs/MultiArrayDimension[] dim\nuint32 data_offset\n================================================================================\nMSG: std_msgs/MultiArrayDimension\nstring label\nuint32 size\nuint32 stride";
        const HASH: &'static str = "RIHS01_5687e861b8d307a5e48b7515467ae7a5fc2daf805bd0ce6d8e9e604bade9f385";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.layout, to);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                layout: Message::read(from)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
}
/// Package `std_srvs`.
pub mod std_srvs {
    use super::*;
    /// `std_srvs/srv/Empty`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct Empty;
    impl Service for Empty {
        const NAME: &'static str = "std_srvs/srv/Empty";
        const HASH: &'static str = "RIHS01_5888399dedec5ccc85ea6451949fd2c9f97bfdf963f9a588821639fcd31b5d19";
        type Request = super::std_srvs::EmptyRequest;
        type Response = super::std_srvs::EmptyResponse;
    }
    /// `std_srvs/srv/Empty_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct EmptyRequest {}
    impl Default for EmptyRequest {
        #[inline]
        fn default() -> Self {
            Self {}
        }
    }
    impl Message for EmptyRequest {
        const NAME: &'static str = "std_srvs/srv/Empty_Request";
        const DEFINITION: &'static str = "";
        const HASH: &'static str = "RIHS01_458eaf200a3f63d9cc53d19436edebc0c140ef4c93ca75d5bd4ce19fd7759e35";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(0_u8);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.empty()?;
            Ok(Self {})
        }
    }
    /// `std_srvs/srv/Empty_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct EmptyResponse {}
    impl Default for EmptyResponse {
        #[inline]
        fn default() -> Self {
            Self {}
        }
    }
    impl Message for EmptyResponse {
        const NAME: &'static str = "std_srvs/srv/Empty_Response";
        const DEFINITION: &'static str = "";
        const HASH: &'static str = "RIHS01_0a2858b3f60df644a61d0fa44cfc923a3d3628e0ad9c8ad8534b1a2c92a413dc";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(0_u8);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.empty()?;
            Ok(Self {})
        }
    }
    /// `std_srvs/srv/SetBool`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct SetBool;
    impl Service for SetBool {
        const NAME: &'static str = "std_srvs/srv/SetBool";
        const HASH: &'static str = "RIHS01_abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a";
        type Request = super::std_srvs::SetBoolRequest;
        type Response = super::std_srvs::SetBoolResponse;
    }
    /// `std_srvs/srv/SetBool_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetBoolRequest {
        pub data: bool,
    }
    impl Default for SetBoolRequest {
        #[inline]
        fn default() -> Self {
            Self { data: Default::default() }
        }
    }
    impl Message for SetBoolRequest {
        const NAME: &'static str = "std_srvs/srv/SetBool_Request";
        const DEFINITION: &'static str = "bool data";
        const HASH: &'static str = "RIHS01_c62fbb99d94e1b25e8ef9e109f9581956bb1b3361a45a4e5810c36a90d29932e";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { data: from.number()? })
        }
    }
    /// `std_srvs/srv/SetBool_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SetBoolResponse {
        pub success: bool,
        pub message: alloc::string::String,
    }
    impl Default for SetBoolResponse {
        #[inline]
        fn default() -> Self {
            Self {
                success: Default::default(),
                message: Default::default(),
            }
        }
    }
    impl Message for SetBoolResponse {
        const NAME: &'static str = "std_srvs/srv/SetBool_Response";
        const DEFINITION: &'static str = "bool success\nstring message";
        const HASH: &'static str = "RIHS01_d0814e7f7b4880ab77e9c57426c7aa1562ab69f11eef8e2e968812f9cbd0b059";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.success);
            to.text(&self.message);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                success: from.number()?,
                message: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `std_srvs/srv/Trigger`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub struct Trigger;
    impl Service for Trigger {
        const NAME: &'static str = "std_srvs/srv/Trigger";
        const HASH: &'static str = "RIHS01_eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f";
        type Request = super::std_srvs::TriggerRequest;
        type Response = super::std_srvs::TriggerResponse;
    }
    /// `std_srvs/srv/Trigger_Request`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TriggerRequest {}
    impl Default for TriggerRequest {
        #[inline]
        fn default() -> Self {
            Self {}
        }
    }
    impl Message for TriggerRequest {
        const NAME: &'static str = "std_srvs/srv/Trigger_Request";
        const DEFINITION: &'static str = "";
        const HASH: &'static str = "RIHS01_d010825374ce8918e72bfd826c82603e60f45419e932ea976f807b74a863a199";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(0_u8);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            from.empty()?;
            Ok(Self {})
        }
    }
    /// `std_srvs/srv/Trigger_Response`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TriggerResponse {
        pub success: bool,
        pub message: alloc::string::String,
    }
    impl Default for TriggerResponse {
        #[inline]
        fn default() -> Self {
            Self {
                success: Default::default(),
                message: Default::default(),
            }
        }
    }
    impl Message for TriggerResponse {
        const NAME: &'static str = "std_srvs/srv/Trigger_Response";
        const DEFINITION: &'static str = "bool success\nstring message";
        const HASH: &'static str = "RIHS01_2d946c21e2fc3f1e9ca6986a8191d85fcc70097a8bb7771a053564bc47009cdf";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.success);
            to.text(&self.message);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                success: from.number()?,
                message: from.text_of(usize::MAX)?,
            })
        }
    }
}
/// Package `tf2_msgs`.
pub mod tf2_msgs {
    use super::*;
    /// `tf2_msgs/msg/TF2Error`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TF2Error {
        pub error: u8,
        pub error_string: alloc::string::String,
    }
    impl TF2Error {
        pub const NO_ERROR: u8 = 0;
        pub const LOOKUP_ERROR: u8 = 1;
        pub const CONNECTIVITY_ERROR: u8 = 2;
        pub const EXTRAPOLATION_ERROR: u8 = 3;
        pub const INVALID_ARGUMENT_ERROR: u8 = 4;
        pub const TIMEOUT_ERROR: u8 = 5;
        pub const TRANSFORM_ERROR: u8 = 6;
    }
    impl Default for TF2Error {
        #[inline]
        fn default() -> Self {
            Self {
                error: Default::default(),
                error_string: Default::default(),
            }
        }
    }
    impl Message for TF2Error {
        const NAME: &'static str = "tf2_msgs/msg/TF2Error";
        const DEFINITION: &'static str = "uint8 NO_ERROR=0\nuint8 LOOKUP_ERROR=1\nuint8 CONNECTIVITY_ERROR=2\nuint8 EXTRAPOLATION_ERROR=3\nuint8 INVALID_ARGUMENT_ERROR=4\nuint8 TIMEOUT_ERROR=5\nuint8 TRANSFORM_ERROR=6\nuint8 error\nstring error_string";
        const HASH: &'static str = "RIHS01_db2485e7d6a0ec75bf087e058ee45df682acc3a621ca7780503d10aac141809a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.error);
            to.text(&self.error_string);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                error: from.number()?,
                error_string: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `tf2_msgs/msg/TFMessage`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct TFMessage {
        pub transforms: alloc::vec::Vec<super::geometry_msgs::TransformStamped>,
    }
    impl Default for TFMessage {
        #[inline]
        fn default() -> Self {
            Self {
                transforms: Default::default(),
            }
        }
    }
    impl Message for TFMessage {
        const NAME: &'static str = "tf2_msgs/msg/TFMessage";
        const DEFINITION: &'static str = "geometry_msgs/TransformStamped[] transforms\n================================================================================\nMSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.transforms.len());
            for element in &self.transforms {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                transforms: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
}
/// Package `trajectory_msgs`.
pub mod trajectory_msgs {
    use super::*;
    /// `trajectory_msgs/msg/JointTrajectory`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct JointTrajectory {
        pub header: super::std_msgs::Header,
        pub joint_names: alloc::vec::Vec<alloc::string::String>,
        pub points: alloc::vec::Vec<super::trajectory_msgs::JointTrajectoryPoint>,
    }
    impl Default for JointTrajectory {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                joint_names: Default::default(),
                points: Default::default(),
            }
        }
    }
    impl Message for JointTrajectory {
        const NAME: &'static str = "trajectory_msgs/msg/JointTrajectory";
        const DEFINITION: &'static str = "std_msgs/Header header\nstring[] joint_names\ntrajectory_msgs/JointTrajectoryPoint[] points\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: trajectory_msgs/JointTrajectoryPoint\nfloat64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\nbuiltin_interfaces/Duration time_from_start\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_179b33eba59d676f6d967ac71fe35e7ca2f64b2f3928f4a018cec115e213796e";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.joint_names.len());
            for element in &self.joint_names {
                to.text(element);
            }
            to.length(self.points.len());
            for element in &self.points {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                joint_names: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
                points: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `trajectory_msgs/msg/JointTrajectoryPoint`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct JointTrajectoryPoint {
        pub positions: alloc::vec::Vec<f64>,
        pub velocities: alloc::vec::Vec<f64>,
        pub accelerations: alloc::vec::Vec<f64>,
        pub effort: alloc::vec::Vec<f64>,
        pub time_from_start: super::builtin_interfaces::Duration,
    }
    impl Default for JointTrajectoryPoint {
        #[inline]
        fn default() -> Self {
            Self {
                positions: Default::default(),
                velocities: Default::default(),
                accelerations: Default::default(),
                effort: Default::default(),
                time_from_start: Default::default(),
            }
        }
    }
    impl Message for JointTrajectoryPoint {
        const NAME: &'static str = "trajectory_msgs/msg/JointTrajectoryPoint";
        const DEFINITION: &'static str = "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\nbuiltin_interfaces/Duration time_from_start\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_de8907036d8bd45aac6f30cc9044a3d4a329c42cbf719aff7d95a584cfa532d7";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.positions.len());
            to.numbers(&self.positions);
            to.length(self.velocities.len());
            to.numbers(&self.velocities);
            to.length(self.accelerations.len());
            to.numbers(&self.accelerations);
            to.length(self.effort.len());
            to.numbers(&self.effort);
            Message::write(&self.time_from_start, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                positions: from.list(usize::MAX)?,
                velocities: from.list(usize::MAX)?,
                accelerations: from.list(usize::MAX)?,
                effort: from.list(usize::MAX)?,
                time_from_start: Message::read(from)?,
            })
        }
    }
    /// `trajectory_msgs/msg/MultiDOFJointTrajectory`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MultiDOFJointTrajectory {
        pub header: super::std_msgs::Header,
        pub joint_names: alloc::vec::Vec<alloc::string::String>,
        pub points: alloc::vec::Vec<
            super::trajectory_msgs::MultiDOFJointTrajectoryPoint,
        >,
    }
    impl Default for MultiDOFJointTrajectory {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                joint_names: Default::default(),
                points: Default::default(),
            }
        }
    }
    impl Message for MultiDOFJointTrajectory {
        const NAME: &'static str = "trajectory_msgs/msg/MultiDOFJointTrajectory";
        const DEFINITION: &'static str = "std_msgs/Header header\nstring[] joint_names\ntrajectory_msgs/MultiDOFJointTrajectoryPoint[] points\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: trajectory_msgs/MultiDOFJointTrajectoryPoint\ngeometry_msgs/Transform[] transforms\ngeometry_msgs/Twist[] velocities\ngeometry_msgs/Twist[] accelerations\nbuiltin_interfaces/Duration time_from_start\n================================================================================\nMSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_3a18fd095292a65cfde8833c72985a30af981f3ec44494655c6267262b443a4a";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.length(self.joint_names.len());
            for element in &self.joint_names {
                to.text(element);
            }
            to.length(self.points.len());
            for element in &self.points {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                joint_names: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
                points: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `trajectory_msgs/msg/MultiDOFJointTrajectoryPoint`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MultiDOFJointTrajectoryPoint {
        pub transforms: alloc::vec::Vec<super::geometry_msgs::Transform>,
        pub velocities: alloc::vec::Vec<super::geometry_msgs::Twist>,
        pub accelerations: alloc::vec::Vec<super::geometry_msgs::Twist>,
        pub time_from_start: super::builtin_interfaces::Duration,
    }
    impl Default for MultiDOFJointTrajectoryPoint {
        #[inline]
        fn default() -> Self {
            Self {
                transforms: Default::default(),
                velocities: Default::default(),
                accelerations: Default::default(),
                time_from_start: Default::default(),
            }
        }
    }
    impl Message for MultiDOFJointTrajectoryPoint {
        const NAME: &'static str = "trajectory_msgs/msg/MultiDOFJointTrajectoryPoint";
        const DEFINITION: &'static str = "geometry_msgs/Transform[] transforms\ngeometry_msgs/Twist[] velocities\ngeometry_msgs/Twist[] accelerations\nbuiltin_interfaces/Duration time_from_start\n================================================================================\nMSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_6ada1085b5ee64eaa069b074968e69f0e27c8c5e6f5bb0586dd1c834ef0e32b8";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.transforms.len());
            for element in &self.transforms {
                Message::write(element, to);
            }
            to.length(self.velocities.len());
            for element in &self.velocities {
                Message::write(element, to);
            }
            to.length(self.accelerations.len());
            for element in &self.accelerations {
                Message::write(element, to);
            }
            Message::write(&self.time_from_start, to);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                transforms: from.list_of(usize::MAX, |from| Message::read(from))?,
                velocities: from.list_of(usize::MAX, |from| Message::read(from))?,
                accelerations: from.list_of(usize::MAX, |from| Message::read(from))?,
                time_from_start: Message::read(from)?,
            })
        }
    }
}
/// Package `unique_identifier_msgs`.
pub mod unique_identifier_msgs {
    use super::*;
    /// `unique_identifier_msgs/msg/UUID`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UUID {
        pub uuid: [u8; 16],
    }
    impl Default for UUID {
        #[inline]
        fn default() -> Self {
            Self { uuid: [0; 16] }
        }
    }
    impl Message for UUID {
        const NAME: &'static str = "unique_identifier_msgs/msg/UUID";
        const DEFINITION: &'static str = "uint8[16] uuid";
        const HASH: &'static str = "RIHS01_1b8e8aca958cbea28fe6ef60bf6c19b683c97a9ef60bb34752067d0f2f7ab437";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.numbers(&self.uuid);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self { uuid: from.array()? })
        }
    }
}
/// Package `visualization_msgs`.
pub mod visualization_msgs {
    use super::*;
    /// `visualization_msgs/msg/ImageMarker`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ImageMarker {
        pub header: super::std_msgs::Header,
        pub ns: alloc::string::String,
        pub id: i32,
        pub r#type: i32,
        pub action: i32,
        pub position: super::geometry_msgs::Point,
        pub scale: f32,
        pub outline_color: super::std_msgs::ColorRGBA,
        pub filled: u8,
        pub fill_color: super::std_msgs::ColorRGBA,
        pub lifetime: super::builtin_interfaces::Duration,
        pub points: alloc::vec::Vec<super::geometry_msgs::Point>,
        pub outline_colors: alloc::vec::Vec<super::std_msgs::ColorRGBA>,
    }
    impl ImageMarker {
        pub const CIRCLE: i32 = 0;
        pub const LINE_STRIP: i32 = 1;
        pub const LINE_LIST: i32 = 2;
        pub const POLYGON: i32 = 3;
        pub const POINTS: i32 = 4;
        pub const ADD: i32 = 0;
        pub const REMOVE: i32 = 1;
    }
    impl Default for ImageMarker {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                ns: Default::default(),
                id: Default::default(),
                r#type: Default::default(),
                action: Default::default(),
                position: Default::default(),
                scale: Default::default(),
                outline_color: Default::default(),
                filled: Default::default(),
                fill_color: Default::default(),
                lifetime: Default::default(),
                points: Default::default(),
                outline_colors: Default::default(),
            }
        }
    }
    impl Message for ImageMarker {
        const NAME: &'static str = "visualization_msgs/msg/ImageMarker";
        const DEFINITION: &'static str = "int32 CIRCLE=0\nint32 LINE_STRIP=1\nint32 LINE_LIST=2\nint32 POLYGON=3\nint32 POINTS=4\nint32 ADD=0\nint32 REMOVE=1\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Point position\nfloat32 scale\nstd_msgs/ColorRGBA outline_color\nuint8 filled\nstd_msgs/ColorRGBA fill_color\nbuiltin_interfaces/Duration lifetime\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] outline_colors\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec";
        const HASH: &'static str = "RIHS01_603152491ef2331c200a5305230d31f6e8704875944b388da0f547c415d11836";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.text(&self.ns);
            to.number(self.id);
            to.number(self.r#type);
            to.number(self.action);
            Message::write(&self.position, to);
            to.number(self.scale);
            Message::write(&self.outline_color, to);
            to.number(self.filled);
            Message::write(&self.fill_color, to);
            Message::write(&self.lifetime, to);
            to.length(self.points.len());
            for element in &self.points {
                Message::write(element, to);
            }
            to.length(self.outline_colors.len());
            for element in &self.outline_colors {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                ns: from.text_of(usize::MAX)?,
                id: from.number()?,
                r#type: from.number()?,
                action: from.number()?,
                position: Message::read(from)?,
                scale: from.number()?,
                outline_color: Message::read(from)?,
                filled: from.number()?,
                fill_color: Message::read(from)?,
                lifetime: Message::read(from)?,
                points: from.list_of(usize::MAX, |from| Message::read(from))?,
                outline_colors: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `visualization_msgs/msg/InteractiveMarker`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct InteractiveMarker {
        pub header: super::std_msgs::Header,
        pub pose: super::geometry_msgs::Pose,
        pub name: alloc::string::String,
        pub description: alloc::string::String,
        pub scale: f32,
        pub menu_entries: alloc::vec::Vec<super::visualization_msgs::MenuEntry>,
        pub controls: alloc::vec::Vec<
            super::visualization_msgs::InteractiveMarkerControl,
        >,
    }
    impl Default for InteractiveMarker {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                pose: Default::default(),
                name: Default::default(),
                description: Default::default(),
                scale: Default::default(),
                menu_entries: Default::default(),
                controls: Default::default(),
            }
        }
    }
    impl Message for InteractiveMarker {
        const NAME: &'static str = "visualization_msgs/msg/InteractiveMarker";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Pose pose\nstring name\nstring description\nfloat32 scale\nvisualization_msgs/MenuEntry[] menu_entries\nvisualization_msgs/InteractiveMarkerControl[] controls\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: visualization_msgs/MenuEntry\nuint8 FEEDBACK=0\nuint8 ROSRUN=1\nuint8 ROSLAUNCH=2\nuint32 id\nuint32 parent_id\nstring title\nstring command\nuint8 command_type\n================================================================================\nMSG: visualization_msgs/InteractiveMarkerControl\nuint8 INHERIT=0\nuint8 FIXED=1\nuint8 VIEW_FACING=2\nuint8 NONE=0\nuint8 MENU=1\nuint8 BUTTON=2\nuint8 MOVE_AXIS=3\nuint8 MOVE_PLANE=4\nuint8 ROTATE_AXIS=5\nuint8 MOVE_ROTATE=6\nuint8 MOVE_3D=7\nuint8 ROTATE_3D=8\nuint8 MOVE_ROTATE_3D=9\nstring name\ngeometry_msgs/Quaternion orientation\nuint8 orientation_mode\nuint8 interaction_mode\nbool always_visible\nvisualization_msgs/Marker[] markers\nbool independent_marker_orientation\nstring description\n================================================================================\nMSG: visualization_msgs/Marker\nint32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\nint32 ARROW_STRIP=12\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n================================================================================\nMSG: visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n================================================================================\nMSG: visualization_msgs/MeshFile\nstring filename\nuint8[] data";
        const HASH: &'static str = "RIHS01_3d5b51448b51d73b0f395b94d259edd3a5d269ae9f7d9fd5cceb9ae4b72be346";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.pose, to);
            to.text(&self.name);
            to.text(&self.description);
            to.number(self.scale);
            to.length(self.menu_entries.len());
            for element in &self.menu_entries {
                Message::write(element, to);
            }
            to.length(self.controls.len());
            for element in &self.controls {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                pose: Message::read(from)?,
                name: from.text_of(usize::MAX)?,
                description: from.text_of(usize::MAX)?,
                scale: from.number()?,
                menu_entries: from.list_of(usize::MAX, |from| Message::read(from))?,
                controls: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `visualization_msgs/msg/InteractiveMarkerControl`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct InteractiveMarkerControl {
        pub name: alloc::string::String,
        pub orientation: super::geometry_msgs::Quaternion,
        pub orientation_mode: u8,
        pub interaction_mode: u8,
        pub always_visible: bool,
        pub markers: alloc::vec::Vec<super::visualization_msgs::Marker>,
        pub independent_marker_orientation: bool,
        pub description: alloc::string::String,
    }
    impl InteractiveMarkerControl {
        pub const INHERIT: u8 = 0;
        pub const FIXED: u8 = 1;
        pub const VIEW_FACING: u8 = 2;
        pub const NONE: u8 = 0;
        pub const MENU: u8 = 1;
        pub const BUTTON: u8 = 2;
        pub const MOVE_AXIS: u8 = 3;
        pub const MOVE_PLANE: u8 = 4;
        pub const ROTATE_AXIS: u8 = 5;
        pub const MOVE_ROTATE: u8 = 6;
        pub const MOVE_3D: u8 = 7;
        pub const ROTATE_3D: u8 = 8;
        pub const MOVE_ROTATE_3D: u8 = 9;
    }
    impl Default for InteractiveMarkerControl {
        #[inline]
        fn default() -> Self {
            Self {
                name: Default::default(),
                orientation: Default::default(),
                orientation_mode: Default::default(),
                interaction_mode: Default::default(),
                always_visible: Default::default(),
                markers: Default::default(),
                independent_marker_orientation: Default::default(),
                description: Default::default(),
            }
        }
    }
    impl Message for InteractiveMarkerControl {
        const NAME: &'static str = "visualization_msgs/msg/InteractiveMarkerControl";
        const DEFINITION: &'static str = "uint8 INHERIT=0\nuint8 FIXED=1\nuint8 VIEW_FACING=2\nuint8 NONE=0\nuint8 MENU=1\nuint8 BUTTON=2\nuint8 MOVE_AXIS=3\nuint8 MOVE_PLANE=4\nuint8 ROTATE_AXIS=5\nuint8 MOVE_ROTATE=6\nuint8 MOVE_3D=7\nuint8 ROTATE_3D=8\nuint8 MOVE_ROTATE_3D=9\nstring name\ngeometry_msgs/Quaternion orientation\nuint8 orientation_mode\nuint8 interaction_mode\nbool always_visible\nvisualization_msgs/Marker[] markers\nbool independent_marker_orientation\nstring description\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: visualization_msgs/Marker\nint32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\nint32 ARROW_STRIP=12\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n================================================================================\nMSG: visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n================================================================================\nMSG: visualization_msgs/MeshFile\nstring filename\nuint8[] data";
        const HASH: &'static str = "RIHS01_60e2fa36344f5f4791b24a809542a18bffd555f563550d4b22b3bbfc31ec0ed5";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.name);
            Message::write(&self.orientation, to);
            to.number(self.orientation_mode);
            to.number(self.interaction_mode);
            to.number(self.always_visible);
            to.length(self.markers.len());
            for element in &self.markers {
                Message::write(element, to);
            }
            to.number(self.independent_marker_orientation);
            to.text(&self.description);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                name: from.text_of(usize::MAX)?,
                orientation: Message::read(from)?,
                orientation_mode: from.number()?,
                interaction_mode: from.number()?,
                always_visible: from.number()?,
                markers: from.list_of(usize::MAX, |from| Message::read(from))?,
                independent_marker_orientation: from.number()?,
                description: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `visualization_msgs/msg/InteractiveMarkerFeedback`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct InteractiveMarkerFeedback {
        pub header: super::std_msgs::Header,
        pub client_id: alloc::string::String,
        pub marker_name: alloc::string::String,
        pub control_name: alloc::string::String,
        pub event_type: u8,
        pub pose: super::geometry_msgs::Pose,
        pub menu_entry_id: u32,
        pub mouse_point: super::geometry_msgs::Point,
        pub mouse_point_valid: bool,
    }
    impl InteractiveMarkerFeedback {
        pub const KEEP_ALIVE: u8 = 0;
        pub const POSE_UPDATE: u8 = 1;
        pub const MENU_SELECT: u8 = 2;
        pub const BUTTON_CLICK: u8 = 3;
        pub const MOUSE_DOWN: u8 = 4;
        pub const MOUSE_UP: u8 = 5;
    }
    impl Default for InteractiveMarkerFeedback {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                client_id: Default::default(),
                marker_name: Default::default(),
                control_name: Default::default(),
                event_type: Default::default(),
                pose: Default::default(),
                menu_entry_id: Default::default(),
                mouse_point: Default::default(),
                mouse_point_valid: Default::default(),
            }
        }
    }
    impl Message for InteractiveMarkerFeedback {
        const NAME: &'static str = "visualization_msgs/msg/InteractiveMarkerFeedback";
        const DEFINITION: &'static str = "uint8 KEEP_ALIVE=0\nuint8 POSE_UPDATE=1\nuint8 MENU_SELECT=2\nuint8 BUTTON_CLICK=3\nuint8 MOUSE_DOWN=4\nuint8 MOUSE_UP=5\nstd_msgs/Header header\nstring client_id\nstring marker_name\nstring control_name\nuint8 event_type\ngeometry_msgs/Pose pose\nuint32 menu_entry_id\ngeometry_msgs/Point mouse_point\nbool mouse_point_valid\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_6cc48741df9f05d19ba7d9ea3101e9fcd1309c9d6bda3c55668ba607492f725e";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.text(&self.client_id);
            to.text(&self.marker_name);
            to.text(&self.control_name);
            to.number(self.event_type);
            Message::write(&self.pose, to);
            to.number(self.menu_entry_id);
            Message::write(&self.mouse_point, to);
            to.number(self.mouse_point_valid);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                client_id: from.text_of(usize::MAX)?,
                marker_name: from.text_of(usize::MAX)?,
                control_name: from.text_of(usize::MAX)?,
                event_type: from.number()?,
                pose: Message::read(from)?,
                menu_entry_id: from.number()?,
                mouse_point: Message::read(from)?,
                mouse_point_valid: from.number()?,
            })
        }
    }
    /// `visualization_msgs/msg/InteractiveMarkerInit`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct InteractiveMarkerInit {
        pub server_id: alloc::string::String,
        pub seq_num: u64,
        pub markers: alloc::vec::Vec<super::visualization_msgs::InteractiveMarker>,
    }
    impl Default for InteractiveMarkerInit {
        #[inline]
        fn default() -> Self {
            Self {
                server_id: Default::default(),
                seq_num: Default::default(),
                markers: Default::default(),
            }
        }
    }
    impl Message for InteractiveMarkerInit {
        const NAME: &'static str = "visualization_msgs/msg/InteractiveMarkerInit";
        const DEFINITION: &'static str = "string server_id\nuint64 seq_num\nvisualization_msgs/InteractiveMarker[] markers\n================================================================================\nMSG: visualization_msgs/InteractiveMarker\nstd_msgs/Header header\ngeometry_msgs/Pose pose\nstring name\nstring description\nfloat32 scale\nvisualization_msgs/MenuEntry[] menu_entries\nvisualization_msgs/InteractiveMarkerControl[] controls\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: visualization_msgs/MenuEntry\nuint8 FEEDBACK=0\nuint8 ROSRUN=1\nuint8 ROSLAUNCH=2\nuint32 id\nuint32 parent_id\nstring title\nstring command\nuint8 command_type\n================================================================================\nMSG: visualization_msgs/InteractiveMarkerControl\nuint8 INHERIT=0\nuint8 FIXED=1\nuint8 VIEW_FACING=2\nuint8 NONE=0\nuint8 MENU=1\nuint8 BUTTON=2\nuint8 MOVE_AXIS=3\nuint8 MOVE_PLANE=4\nuint8 ROTATE_AXIS=5\nuint8 MOVE_ROTATE=6\nuint8 MOVE_3D=7\nuint8 ROTATE_3D=8\nuint8 MOVE_ROTATE_3D=9\nstring name\ngeometry_msgs/Quaternion orientation\nuint8 orientation_mode\nuint8 interaction_mode\nbool always_visible\nvisualization_msgs/Marker[] markers\nbool independent_marker_orientation\nstring description\n================================================================================\nMSG: visualization_msgs/Marker\nint32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\nint32 ARROW_STRIP=12\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n================================================================================\nMSG: visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n================================================================================\nMSG: visualization_msgs/MeshFile\nstring filename\nuint8[] data";
        const HASH: &'static str = "RIHS01_23fda1b3373b154d9d6408dd7b9f8129b2a2b76b905ee421e8c4109d8bf71f78";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.server_id);
            to.number(self.seq_num);
            to.length(self.markers.len());
            for element in &self.markers {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                server_id: from.text_of(usize::MAX)?,
                seq_num: from.number()?,
                markers: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `visualization_msgs/msg/InteractiveMarkerPose`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct InteractiveMarkerPose {
        pub header: super::std_msgs::Header,
        pub pose: super::geometry_msgs::Pose,
        pub name: alloc::string::String,
    }
    impl Default for InteractiveMarkerPose {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                pose: Default::default(),
                name: Default::default(),
            }
        }
    }
    impl Message for InteractiveMarkerPose {
        const NAME: &'static str = "visualization_msgs/msg/InteractiveMarkerPose";
        const DEFINITION: &'static str = "std_msgs/Header header\ngeometry_msgs/Pose pose\nstring name\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
        const HASH: &'static str = "RIHS01_c60e9a4407d5f709a63e0fe9caea324aee08fe717cd090209ebe35012ce7cb66";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            Message::write(&self.pose, to);
            to.text(&self.name);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                pose: Message::read(from)?,
                name: from.text_of(usize::MAX)?,
            })
        }
    }
    /// `visualization_msgs/msg/InteractiveMarkerUpdate`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct InteractiveMarkerUpdate {
        pub server_id: alloc::string::String,
        pub seq_num: u64,
        pub r#type: u8,
        pub markers: alloc::vec::Vec<super::visualization_msgs::InteractiveMarker>,
        pub poses: alloc::vec::Vec<super::visualization_msgs::InteractiveMarkerPose>,
        pub erases: alloc::vec::Vec<alloc::string::String>,
    }
    impl InteractiveMarkerUpdate {
        pub const KEEP_ALIVE: u8 = 0;
        pub const UPDATE: u8 = 1;
    }
    impl Default for InteractiveMarkerUpdate {
        #[inline]
        fn default() -> Self {
            Self {
                server_id: Default::default(),
                seq_num: Default::default(),
                r#type: Default::default(),
                markers: Default::default(),
                poses: Default::default(),
                erases: Default::default(),
            }
        }
    }
    impl Message for InteractiveMarkerUpdate {
        const NAME: &'static str = "visualization_msgs/msg/InteractiveMarkerUpdate";
        const DEFINITION: &'static str = "uint8 KEEP_ALIVE=0\nuint8 UPDATE=1\nstring server_id\nuint64 seq_num\nuint8 type\nvisualization_msgs/InteractiveMarker[] markers\nvisualization_msgs/InteractiveMarkerPose[] poses\nstring[] erases\n================================================================================\nMSG: visualization_msgs/InteractiveMarker\nstd_msgs/Header header\ngeometry_msgs/Pose pose\nstring name\nstring description\nfloat32 scale\nvisualization_msgs/MenuEntry[] menu_entries\nvisualization_msgs/InteractiveMarkerControl[] controls\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: visualization_msgs/MenuEntry\nuint8 FEEDBACK=0\nuint8 ROSRUN=1\nuint8 ROSLAUNCH=2\nuint32 id\nuint32 parent_id\nstring title\nstring command\nuint8 command_type\n================================================================================\nMSG: visualization_msgs/InteractiveMarkerControl\nuint8 INHERIT=0\nuint8 FIXED=1\nuint8 VIEW_FACING=2\nuint8 NONE=0\nuint8 MENU=1\nuint8 BUTTON=2\nuint8 MOVE_AXIS=3\nuint8 MOVE_PLANE=4\nuint8 ROTATE_AXIS=5\nuint8 MOVE_ROTATE=6\nuint8 MOVE_3D=7\nuint8 ROTATE_3D=8\nuint8 MOVE_ROTATE_3D=9\nstring name\ngeometry_msgs/Quaternion orientation\nuint8 orientation_mode\nuint8 interaction_mode\nbool always_visible\nvisualization_msgs/Marker[] markers\nbool independent_marker_orientation\nstring description\n================================================================================\nMSG: visualization_msgs/Marker\nint32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\nint32 ARROW_STRIP=12\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n================================================================================\nMSG: visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n================================================================================\nMSG: visualization_msgs/MeshFile\nstring filename\nuint8[] data\n================================================================================\nMSG: visualization_msgs/InteractiveMarkerPose\nstd_msgs/Header header\ngeometry_msgs/Pose pose\nstring name";
        const HASH: &'static str = "RIHS01_0a8b000c4fd4d50876ac716a7de018911599a2f015795388e956a2ca8b0c54f0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.server_id);
            to.number(self.seq_num);
            to.number(self.r#type);
            to.length(self.markers.len());
            for element in &self.markers {
                Message::write(element, to);
            }
            to.length(self.poses.len());
            for element in &self.poses {
                Message::write(element, to);
            }
            to.length(self.erases.len());
            for element in &self.erases {
                to.text(element);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                server_id: from.text_of(usize::MAX)?,
                seq_num: from.number()?,
                r#type: from.number()?,
                markers: from.list_of(usize::MAX, |from| Message::read(from))?,
                poses: from.list_of(usize::MAX, |from| Message::read(from))?,
                erases: from.list_of(usize::MAX, |from| from.text_of(usize::MAX))?,
            })
        }
    }
    /// `visualization_msgs/msg/Marker`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Marker {
        pub header: super::std_msgs::Header,
        pub ns: alloc::string::String,
        pub id: i32,
        pub r#type: i32,
        pub action: i32,
        pub pose: super::geometry_msgs::Pose,
        pub scale: super::geometry_msgs::Vector3,
        pub color: super::std_msgs::ColorRGBA,
        pub lifetime: super::builtin_interfaces::Duration,
        pub frame_locked: bool,
        pub points: alloc::vec::Vec<super::geometry_msgs::Point>,
        pub colors: alloc::vec::Vec<super::std_msgs::ColorRGBA>,
        pub texture_resource: alloc::string::String,
        pub texture: super::sensor_msgs::CompressedImage,
        pub uv_coordinates: alloc::vec::Vec<super::visualization_msgs::UVCoordinate>,
        pub text: alloc::string::String,
        pub mesh_resource: alloc::string::String,
        pub mesh_file: super::visualization_msgs::MeshFile,
        pub mesh_use_embedded_materials: bool,
    }
    impl Marker {
        pub const ARROW: i32 = 0;
        pub const CUBE: i32 = 1;
        pub const SPHERE: i32 = 2;
        pub const CYLINDER: i32 = 3;
        pub const LINE_STRIP: i32 = 4;
        pub const LINE_LIST: i32 = 5;
        pub const CUBE_LIST: i32 = 6;
        pub const SPHERE_LIST: i32 = 7;
        pub const POINTS: i32 = 8;
        pub const TEXT_VIEW_FACING: i32 = 9;
        pub const MESH_RESOURCE: i32 = 10;
        pub const TRIANGLE_LIST: i32 = 11;
        pub const ARROW_STRIP: i32 = 12;
        pub const ADD: i32 = 0;
        pub const MODIFY: i32 = 0;
        pub const DELETE: i32 = 2;
        pub const DELETEALL: i32 = 3;
    }
    impl Default for Marker {
        #[inline]
        fn default() -> Self {
            Self {
                header: Default::default(),
                ns: Default::default(),
                id: Default::default(),
                r#type: Default::default(),
                action: Default::default(),
                pose: Default::default(),
                scale: Default::default(),
                color: Default::default(),
                lifetime: Default::default(),
                frame_locked: Default::default(),
                points: Default::default(),
                colors: Default::default(),
                texture_resource: Default::default(),
                texture: Default::default(),
                uv_coordinates: Default::default(),
                text: Default::default(),
                mesh_resource: Default::default(),
                mesh_file: Default::default(),
                mesh_use_embedded_materials: Default::default(),
            }
        }
    }
    impl Message for Marker {
        const NAME: &'static str = "visualization_msgs/msg/Marker";
        const DEFINITION: &'static str = "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\nint32 ARROW_STRIP=12\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n================================================================================\nMSG: visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n================================================================================\nMSG: visualization_msgs/MeshFile\nstring filename\nuint8[] data";
        const HASH: &'static str = "RIHS01_45b13ccf791f225962bf74e746f9644518855d783a6f42ba0cc14fde2b4f3ce0";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            Message::write(&self.header, to);
            to.text(&self.ns);
            to.number(self.id);
            to.number(self.r#type);
            to.number(self.action);
            Message::write(&self.pose, to);
            Message::write(&self.scale, to);
            Message::write(&self.color, to);
            Message::write(&self.lifetime, to);
            to.number(self.frame_locked);
            to.length(self.points.len());
            for element in &self.points {
                Message::write(element, to);
            }
            to.length(self.colors.len());
            for element in &self.colors {
                Message::write(element, to);
            }
            to.text(&self.texture_resource);
            Message::write(&self.texture, to);
            to.length(self.uv_coordinates.len());
            for element in &self.uv_coordinates {
                Message::write(element, to);
            }
            to.text(&self.text);
            to.text(&self.mesh_resource);
            Message::write(&self.mesh_file, to);
            to.number(self.mesh_use_embedded_materials);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                header: Message::read(from)?,
                ns: from.text_of(usize::MAX)?,
                id: from.number()?,
                r#type: from.number()?,
                action: from.number()?,
                pose: Message::read(from)?,
                scale: Message::read(from)?,
                color: Message::read(from)?,
                lifetime: Message::read(from)?,
                frame_locked: from.number()?,
                points: from.list_of(usize::MAX, |from| Message::read(from))?,
                colors: from.list_of(usize::MAX, |from| Message::read(from))?,
                texture_resource: from.text_of(usize::MAX)?,
                texture: Message::read(from)?,
                uv_coordinates: from.list_of(usize::MAX, |from| Message::read(from))?,
                text: from.text_of(usize::MAX)?,
                mesh_resource: from.text_of(usize::MAX)?,
                mesh_file: Message::read(from)?,
                mesh_use_embedded_materials: from.number()?,
            })
        }
    }
    /// `visualization_msgs/msg/MarkerArray`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MarkerArray {
        pub markers: alloc::vec::Vec<super::visualization_msgs::Marker>,
    }
    impl Default for MarkerArray {
        #[inline]
        fn default() -> Self {
            Self {
                markers: Default::default(),
            }
        }
    }
    impl Message for MarkerArray {
        const NAME: &'static str = "visualization_msgs/msg/MarkerArray";
        const DEFINITION: &'static str = "visualization_msgs/Marker[] markers\n================================================================================\nMSG: visualization_msgs/Marker\nint32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\nint32 ARROW_STRIP=12\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n================================================================================\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n================================================================================\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n================================================================================\nMSG: std_msgs/ColorRGBA\nfloat32 r\nfloat32 g\nfloat32 b\nfloat32 a\n================================================================================\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n================================================================================\nMSG: sensor_msgs/CompressedImage\nstd_msgs/Header header\nstring format\nuint8[] data\n================================================================================\nMSG: visualization_msgs/UVCoordinate\nfloat32 u\nfloat32 v\n================================================================================\nMSG: visualization_msgs/MeshFile\nstring filename\nuint8[] data";
        const HASH: &'static str = "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.length(self.markers.len());
            for element in &self.markers {
                Message::write(element, to);
            }
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                markers: from.list_of(usize::MAX, |from| Message::read(from))?,
            })
        }
    }
    /// `visualization_msgs/msg/MenuEntry`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MenuEntry {
        pub id: u32,
        pub parent_id: u32,
        pub title: alloc::string::String,
        pub command: alloc::string::String,
        pub command_type: u8,
    }
    impl MenuEntry {
        pub const FEEDBACK: u8 = 0;
        pub const ROSRUN: u8 = 1;
        pub const ROSLAUNCH: u8 = 2;
    }
    impl Default for MenuEntry {
        #[inline]
        fn default() -> Self {
            Self {
                id: Default::default(),
                parent_id: Default::default(),
                title: Default::default(),
                command: Default::default(),
                command_type: Default::default(),
            }
        }
    }
    impl Message for MenuEntry {
        const NAME: &'static str = "visualization_msgs/msg/MenuEntry";
        const DEFINITION: &'static str = "uint8 FEEDBACK=0\nuint8 ROSRUN=1\nuint8 ROSLAUNCH=2\nuint32 id\nuint32 parent_id\nstring title\nstring command\nuint8 command_type";
        const HASH: &'static str = "RIHS01_22170c387c70fd4236232ec902de8604e72ff027342c7c0f28ad9f68c64c51d6";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.id);
            to.number(self.parent_id);
            to.text(&self.title);
            to.text(&self.command);
            to.number(self.command_type);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                id: from.number()?,
                parent_id: from.number()?,
                title: from.text_of(usize::MAX)?,
                command: from.text_of(usize::MAX)?,
                command_type: from.number()?,
            })
        }
    }
    /// `visualization_msgs/msg/MeshFile`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct MeshFile {
        pub filename: alloc::string::String,
        pub data: alloc::vec::Vec<u8>,
    }
    impl Default for MeshFile {
        #[inline]
        fn default() -> Self {
            Self {
                filename: Default::default(),
                data: Default::default(),
            }
        }
    }
    impl Message for MeshFile {
        const NAME: &'static str = "visualization_msgs/msg/MeshFile";
        const DEFINITION: &'static str = "string filename\nuint8[] data";
        const HASH: &'static str = "RIHS01_7710ece15a148fb7c9b546364cfb215bb06098087bd6394fe5b73a493508f8c4";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.text(&self.filename);
            to.length(self.data.len());
            to.numbers(&self.data);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                filename: from.text_of(usize::MAX)?,
                data: from.list(usize::MAX)?,
            })
        }
    }
    /// `visualization_msgs/msg/UVCoordinate`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct UVCoordinate {
        pub u: f32,
        pub v: f32,
    }
    impl Default for UVCoordinate {
        #[inline]
        fn default() -> Self {
            Self {
                u: Default::default(),
                v: Default::default(),
            }
        }
    }
    impl Message for UVCoordinate {
        const NAME: &'static str = "visualization_msgs/msg/UVCoordinate";
        const DEFINITION: &'static str = "float32 u\nfloat32 v";
        const HASH: &'static str = "RIHS01_f27f7ed21fe360c6066944f856b801a0c0d1e94e815b6886444b42d90b196a26";
        #[inline]
        fn write(&self, to: &mut Writer<'_>) {
            to.number(self.u);
            to.number(self.v);
        }
        #[inline]
        fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {
            Ok(Self {
                u: from.number()?,
                v: from.number()?,
            })
        }
    }
}
/// All messages, in the order of their names.
pub const ALL: &[Known] = &[
    Known::of::<action_msgs::GoalInfo>(),
    Known::of::<action_msgs::GoalStatus>(),
    Known::of::<action_msgs::GoalStatusArray>(),
    Known::of::<action_msgs::CancelGoalRequest>(),
    Known::of::<action_msgs::CancelGoalResponse>(),
    Known::of::<builtin_interfaces::Duration>(),
    Known::of::<builtin_interfaces::Time>(),
    Known::of::<diagnostic_msgs::DiagnosticArray>(),
    Known::of::<diagnostic_msgs::DiagnosticStatus>(),
    Known::of::<diagnostic_msgs::KeyValue>(),
    Known::of::<example_interfaces::FibonacciFeedback>(),
    Known::of::<example_interfaces::FibonacciFeedbackMessage>(),
    Known::of::<example_interfaces::FibonacciGetResultRequest>(),
    Known::of::<example_interfaces::FibonacciGetResultResponse>(),
    Known::of::<example_interfaces::FibonacciGoal>(),
    Known::of::<example_interfaces::FibonacciResult>(),
    Known::of::<example_interfaces::FibonacciSendGoalRequest>(),
    Known::of::<example_interfaces::FibonacciSendGoalResponse>(),
    Known::of::<example_interfaces::AddTwoIntsRequest>(),
    Known::of::<example_interfaces::AddTwoIntsResponse>(),
    Known::of::<foxglove_msgs::Grid>(),
    Known::of::<foxglove_msgs::PackedElementField>(),
    Known::of::<foxglove_msgs::Vector2>(),
    Known::of::<geometry_msgs::Accel>(),
    Known::of::<geometry_msgs::AccelStamped>(),
    Known::of::<geometry_msgs::AccelWithCovariance>(),
    Known::of::<geometry_msgs::AccelWithCovarianceStamped>(),
    Known::of::<geometry_msgs::Inertia>(),
    Known::of::<geometry_msgs::InertiaStamped>(),
    Known::of::<geometry_msgs::Point>(),
    Known::of::<geometry_msgs::Point32>(),
    Known::of::<geometry_msgs::PointStamped>(),
    Known::of::<geometry_msgs::Polygon>(),
    Known::of::<geometry_msgs::PolygonInstance>(),
    Known::of::<geometry_msgs::PolygonInstanceStamped>(),
    Known::of::<geometry_msgs::PolygonStamped>(),
    Known::of::<geometry_msgs::Pose>(),
    Known::of::<geometry_msgs::Pose2D>(),
    Known::of::<geometry_msgs::PoseArray>(),
    Known::of::<geometry_msgs::PoseStamped>(),
    Known::of::<geometry_msgs::PoseWithCovariance>(),
    Known::of::<geometry_msgs::PoseWithCovarianceStamped>(),
    Known::of::<geometry_msgs::Quaternion>(),
    Known::of::<geometry_msgs::QuaternionStamped>(),
    Known::of::<geometry_msgs::Transform>(),
    Known::of::<geometry_msgs::TransformStamped>(),
    Known::of::<geometry_msgs::Twist>(),
    Known::of::<geometry_msgs::TwistStamped>(),
    Known::of::<geometry_msgs::TwistWithCovariance>(),
    Known::of::<geometry_msgs::TwistWithCovarianceStamped>(),
    Known::of::<geometry_msgs::Vector3>(),
    Known::of::<geometry_msgs::Vector3Stamped>(),
    Known::of::<geometry_msgs::VelocityStamped>(),
    Known::of::<geometry_msgs::Wrench>(),
    Known::of::<geometry_msgs::WrenchStamped>(),
    Known::of::<lifecycle_msgs::State>(),
    Known::of::<lifecycle_msgs::Transition>(),
    Known::of::<lifecycle_msgs::TransitionDescription>(),
    Known::of::<lifecycle_msgs::TransitionEvent>(),
    Known::of::<lifecycle_msgs::ChangeStateRequest>(),
    Known::of::<lifecycle_msgs::ChangeStateResponse>(),
    Known::of::<lifecycle_msgs::GetAvailableStatesRequest>(),
    Known::of::<lifecycle_msgs::GetAvailableStatesResponse>(),
    Known::of::<lifecycle_msgs::GetAvailableTransitionsRequest>(),
    Known::of::<lifecycle_msgs::GetAvailableTransitionsResponse>(),
    Known::of::<lifecycle_msgs::GetStateRequest>(),
    Known::of::<lifecycle_msgs::GetStateResponse>(),
    Known::of::<nav_msgs::Goals>(),
    Known::of::<nav_msgs::GridCells>(),
    Known::of::<nav_msgs::MapMetaData>(),
    Known::of::<nav_msgs::OccupancyGrid>(),
    Known::of::<nav_msgs::Odometry>(),
    Known::of::<nav_msgs::Path>(),
    Known::of::<nav_msgs::GetMapRequest>(),
    Known::of::<nav_msgs::GetMapResponse>(),
    Known::of::<nav_msgs::GetPlanRequest>(),
    Known::of::<nav_msgs::GetPlanResponse>(),
    Known::of::<nav_msgs::LoadMapRequest>(),
    Known::of::<nav_msgs::LoadMapResponse>(),
    Known::of::<nav_msgs::SetMapRequest>(),
    Known::of::<nav_msgs::SetMapResponse>(),
    Known::of::<rcl_interfaces::FloatingPointRange>(),
    Known::of::<rcl_interfaces::IntegerRange>(),
    Known::of::<rcl_interfaces::ListParametersResult>(),
    Known::of::<rcl_interfaces::Log>(),
    Known::of::<rcl_interfaces::LoggerLevel>(),
    Known::of::<rcl_interfaces::Parameter>(),
    Known::of::<rcl_interfaces::ParameterDescriptor>(),
    Known::of::<rcl_interfaces::ParameterEvent>(),
    Known::of::<rcl_interfaces::ParameterEventDescriptors>(),
    Known::of::<rcl_interfaces::ParameterType>(),
    Known::of::<rcl_interfaces::ParameterValue>(),
    Known::of::<rcl_interfaces::SetLoggerLevelsResult>(),
    Known::of::<rcl_interfaces::SetParametersResult>(),
    Known::of::<rcl_interfaces::DescribeParametersRequest>(),
    Known::of::<rcl_interfaces::DescribeParametersResponse>(),
    Known::of::<rcl_interfaces::GetParameterTypesRequest>(),
    Known::of::<rcl_interfaces::GetParameterTypesResponse>(),
    Known::of::<rcl_interfaces::GetParametersRequest>(),
    Known::of::<rcl_interfaces::GetParametersResponse>(),
    Known::of::<rcl_interfaces::ListParametersRequest>(),
    Known::of::<rcl_interfaces::ListParametersResponse>(),
    Known::of::<rcl_interfaces::SetParametersAtomicallyRequest>(),
    Known::of::<rcl_interfaces::SetParametersAtomicallyResponse>(),
    Known::of::<rcl_interfaces::SetParametersRequest>(),
    Known::of::<rcl_interfaces::SetParametersResponse>(),
    Known::of::<rosgraph_msgs::Clock>(),
    Known::of::<sensor_msgs::BatteryState>(),
    Known::of::<sensor_msgs::CameraInfo>(),
    Known::of::<sensor_msgs::ChannelFloat32>(),
    Known::of::<sensor_msgs::CompressedImage>(),
    Known::of::<sensor_msgs::FluidPressure>(),
    Known::of::<sensor_msgs::Illuminance>(),
    Known::of::<sensor_msgs::Image>(),
    Known::of::<sensor_msgs::Imu>(),
    Known::of::<sensor_msgs::JointState>(),
    Known::of::<sensor_msgs::Joy>(),
    Known::of::<sensor_msgs::JoyFeedback>(),
    Known::of::<sensor_msgs::JoyFeedbackArray>(),
    Known::of::<sensor_msgs::LaserEcho>(),
    Known::of::<sensor_msgs::LaserScan>(),
    Known::of::<sensor_msgs::MagneticField>(),
    Known::of::<sensor_msgs::MultiDOFJointState>(),
    Known::of::<sensor_msgs::MultiEchoLaserScan>(),
    Known::of::<sensor_msgs::NavSatFix>(),
    Known::of::<sensor_msgs::NavSatStatus>(),
    Known::of::<sensor_msgs::PointCloud>(),
    Known::of::<sensor_msgs::PointCloud2>(),
    Known::of::<sensor_msgs::PointField>(),
    Known::of::<sensor_msgs::Range>(),
    Known::of::<sensor_msgs::RegionOfInterest>(),
    Known::of::<sensor_msgs::RelativeHumidity>(),
    Known::of::<sensor_msgs::Temperature>(),
    Known::of::<sensor_msgs::TimeReference>(),
    Known::of::<service_msgs::ServiceEventInfo>(),
    Known::of::<shape_msgs::Mesh>(),
    Known::of::<shape_msgs::MeshTriangle>(),
    Known::of::<shape_msgs::Plane>(),
    Known::of::<shape_msgs::SolidPrimitive>(),
    Known::of::<std_msgs::Bool>(),
    Known::of::<std_msgs::Byte>(),
    Known::of::<std_msgs::ByteMultiArray>(),
    Known::of::<std_msgs::Char>(),
    Known::of::<std_msgs::ColorRGBA>(),
    Known::of::<std_msgs::Empty>(),
    Known::of::<std_msgs::Float32>(),
    Known::of::<std_msgs::Float32MultiArray>(),
    Known::of::<std_msgs::Float64>(),
    Known::of::<std_msgs::Float64MultiArray>(),
    Known::of::<std_msgs::Header>(),
    Known::of::<std_msgs::Int16>(),
    Known::of::<std_msgs::Int16MultiArray>(),
    Known::of::<std_msgs::Int32>(),
    Known::of::<std_msgs::Int32MultiArray>(),
    Known::of::<std_msgs::Int64>(),
    Known::of::<std_msgs::Int64MultiArray>(),
    Known::of::<std_msgs::Int8>(),
    Known::of::<std_msgs::Int8MultiArray>(),
    Known::of::<std_msgs::MultiArrayDimension>(),
    Known::of::<std_msgs::MultiArrayLayout>(),
    Known::of::<std_msgs::String>(),
    Known::of::<std_msgs::UInt16>(),
    Known::of::<std_msgs::UInt16MultiArray>(),
    Known::of::<std_msgs::UInt32>(),
    Known::of::<std_msgs::UInt32MultiArray>(),
    Known::of::<std_msgs::UInt64>(),
    Known::of::<std_msgs::UInt64MultiArray>(),
    Known::of::<std_msgs::UInt8>(),
    Known::of::<std_msgs::UInt8MultiArray>(),
    Known::of::<std_srvs::EmptyRequest>(),
    Known::of::<std_srvs::EmptyResponse>(),
    Known::of::<std_srvs::SetBoolRequest>(),
    Known::of::<std_srvs::SetBoolResponse>(),
    Known::of::<std_srvs::TriggerRequest>(),
    Known::of::<std_srvs::TriggerResponse>(),
    Known::of::<tf2_msgs::TF2Error>(),
    Known::of::<tf2_msgs::TFMessage>(),
    Known::of::<trajectory_msgs::JointTrajectory>(),
    Known::of::<trajectory_msgs::JointTrajectoryPoint>(),
    Known::of::<trajectory_msgs::MultiDOFJointTrajectory>(),
    Known::of::<trajectory_msgs::MultiDOFJointTrajectoryPoint>(),
    Known::of::<unique_identifier_msgs::UUID>(),
    Known::of::<visualization_msgs::ImageMarker>(),
    Known::of::<visualization_msgs::InteractiveMarker>(),
    Known::of::<visualization_msgs::InteractiveMarkerControl>(),
    Known::of::<visualization_msgs::InteractiveMarkerFeedback>(),
    Known::of::<visualization_msgs::InteractiveMarkerInit>(),
    Known::of::<visualization_msgs::InteractiveMarkerPose>(),
    Known::of::<visualization_msgs::InteractiveMarkerUpdate>(),
    Known::of::<visualization_msgs::Marker>(),
    Known::of::<visualization_msgs::MarkerArray>(),
    Known::of::<visualization_msgs::MenuEntry>(),
    Known::of::<visualization_msgs::MeshFile>(),
    Known::of::<visualization_msgs::UVCoordinate>(),
];
