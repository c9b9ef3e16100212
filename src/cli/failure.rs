//! Why a command stopped: the exit code and the message.

/// Why a command stopped.
pub(super) enum Failure {
    /// The input is refused: exit code 2.
    Input(String),
    /// The outputs cannot be written: exit code 1.
    Output(String),
}
