//! Moves the printed frames of a worked example from the node they were printed for to the node on the bench.

use fieldproof_can::{Frame, Id};
use fieldproof_suite::model::{Case, Located, Step};
use fieldproof_suite::scalar::{FrameText, PatternText};
use fieldproof_wire::canopen::{NodeId, Service, cob_id, identify};

/// Moves every frame of `case` from the node it was printed for to `node`.
pub(crate) fn relocate(case: &mut Case, node: NodeId) {
    let Some(printed_for) = case.written_for.node.and_then(NodeId::new) else {
        return;
    };
    if printed_for == node || case.written_for.fixed {
        return;
    }
    let parts = [&mut case.control, &mut case.steps, &mut case.restore.steps];
    for step in parts.into_iter().flatten() {
        relocate_step(step, printed_for, node);
    }
}

fn relocate_step(step: &mut Located<Step>, from: NodeId, to: NodeId) {
    match &mut step.value {
        Step::Send(send) => send.frame = FrameText(relocate_frame(send.frame.0, from, to)),
        Step::Expect(expect) => {
            for PatternText(pattern) in [&mut expect.frame].into_iter().chain(&mut expect.or) {
                *pattern = pattern.with_id(relocate_id(pattern.id(), from, to));
            }
        }
        Step::ExpectSilence(silence) => {
            for id in &mut silence.of {
                if let Some(Id::Standard(moved)) =
                    Id::standard(*id).map(|id| relocate_id(id, from, to))
                {
                    *id = moved.raw();
                }
            }
        }
        Step::Repeat(repeat) => {
            for step in &mut repeat.steps {
                relocate_step(step, from, to);
            }
        }
        _ => {}
    }
}

/// The identifier, and byte 1 of an NMT command.
fn relocate_frame(frame: Frame, from: NodeId, to: NodeId) -> Frame {
    if frame.standard_id() == Some(cob_id(Service::Nmt, None))
        && let [command, node] = frame.bytes()
        && *node == from.raw()
    {
        return Frame::data(frame.id(), &[*command, to.raw()]).unwrap_or(frame);
    }
    frame.with_id(relocate_id(frame.id(), from, to))
}

fn relocate_id(id: Id, from: NodeId, to: NodeId) -> Id {
    let Id::Standard(standard) = id else {
        return id;
    };
    match identify(standard) {
        Some((service, Some(node))) if node == from => Id::Standard(cob_id(service, Some(to))),
        _ => id,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moved(text: &str) -> String {
        let frame: Frame = text.parse().expect("a frame");
        let (from, to) = (
            NodeId::new(0x20).expect("a node"),
            NodeId::new(5).expect("a node"),
        );
        relocate_frame(frame, from, to).to_string()
    }

    #[test]
    fn identifiers_of_the_node_and_nmt_commands_are_moved() {
        assert_eq!(moved("620#2F00300005000000"), "605#2F00300005000000");
        assert_eq!(moved("720#00"), "705#00");
        assert_eq!(moved("000#8020"), "000#8005");
        assert_eq!(moved("1A0#"), "185#");
    }

    #[test]
    fn what_belongs_to_no_node_or_to_another_stays() {
        assert_eq!(moved("000#0100"), "000#0100");
        assert_eq!(moved("7E5#0401000000000000"), "7E5#0401000000000000");
        assert_eq!(moved("080#"), "080#");
        assert_eq!(moved("621#4000100000000000"), "621#4000100000000000");
    }
}
