"""What each decorator does with its child.

Source: facts about BehaviorTree.CPP 4.6 to 4.10, seen in runs of the engine.
"""

from __future__ import annotations

from btq_lang.catalog.nodes import BUILTINS
from btq_lang.simulator.blackboard import Value, parsed
from btq_lang.simulator.errors import EngineError, NotModelled
from btq_lang.simulator.nodes import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Machine, SimulatedNode
from btq_lang.simulator.ports import key_of, read, read_status, read_truth, read_whole, write
from btq_lang.simulator.scripts import holds
from btq_lang.simulator.ticking import check_rounds, execute_tick, halt_children, reset_child, set_status


def tick_inverter(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS and FAILURE exchanged."""
    return _mapped(machine, node, FAILURE, SUCCESS)


def tick_force_success(machine: Machine, node: SimulatedNode) -> int:
    """SUCCESS once the child has ended."""
    return _mapped(machine, node, SUCCESS, SUCCESS)


def tick_force_failure(machine: Machine, node: SimulatedNode) -> int:
    """FAILURE once the child has ended."""
    return _mapped(machine, node, FAILURE, FAILURE)


def _mapped(machine: Machine, node: SimulatedNode, success: int, failure: int) -> int:
    set_status(machine, node, RUNNING)
    result = execute_tick(machine, node.child)
    if result not in (SUCCESS, FAILURE):
        return result
    reset_child(machine, node.child)
    return success if result == SUCCESS else failure


def tick_keep_running_until_failure(machine: Machine, node: SimulatedNode) -> int:
    """RUNNING until the child fails."""
    set_status(machine, node, RUNNING)
    result = execute_tick(machine, node.child)
    if result in (SUCCESS, FAILURE):
        reset_child(machine, node.child)
    if result == FAILURE:
        return FAILURE
    return RUNNING


def tick_repeat(machine: Machine, node: SimulatedNode) -> int:
    """The child again while it succeeds, so many times."""
    return _again(machine, node, "num_cycles", "RepeatNode", SUCCESS, FAILURE)


def tick_retry(machine: Machine, node: SimulatedNode) -> int:
    """The child again while it fails, so many times."""
    return _again(machine, node, "num_attempts", "RetryNode", FAILURE, SUCCESS)


def _again(machine: Machine, node: SimulatedNode, port: str, class_name: str, counted: int, ends: int) -> int:
    """Tick the child until it has had the result `counted` so many times, or once the result `ends`."""
    most = read_whole(node, port)
    if most is None:
        raise EngineError(f"Missing parameter [{port}] in {class_name}")
    if node.status == IDLE:
        node.is_on = True  # all results so far were skips
    set_status(machine, node, RUNNING)
    rounds = 0
    while node.count < most or most == -1:
        check_rounds(node, rounds := rounds + 1)
        child = node.child
        before = child.status
        result = execute_tick(machine, child)
        if result != SKIPPED:
            node.is_on = False
        if result == RUNNING:
            return RUNNING
        if result == counted:
            node.count += 1
            if counted == FAILURE and machine.dialect.reads_attempts_again:
                again = read_whole(node, port)
                most = again if again is not None else most
        elif result == ends:
            node.count = 0
        reset_child(machine, child)
        if result in (ends, SKIPPED):
            return result
        if node.rules.yields and before == IDLE and (node.count < most or most == -1):
            machine.wake(node)
            return RUNNING
    node.count = 0
    return SKIPPED if node.is_on and not machine.dialect.counts_skips else counted


def halt_counting(machine: Machine, node: SimulatedNode) -> None:
    """Begin to count from 0 again."""
    node.count = 0
    halt_children(machine, node)


def tick_run_once(machine: Machine, node: SimulatedNode) -> int:
    """The child until it has ended once, and never again."""
    if node.is_on:
        return node.result if read_truth(node, "then_skip") is False else SKIPPED
    set_status(machine, node, RUNNING)
    result = execute_tick(machine, node.child)
    if result in (SUCCESS, FAILURE):
        node.is_on = True
        node.result = result
        reset_child(machine, node.child)
    return result


def tick_precondition(machine: Machine, node: SimulatedNode) -> int:
    """The child, if a condition is true when it begins."""
    otherwise = read_status(node, "else")
    if otherwise is None:
        raise EngineError("Missing parameter [else] in Precondition")
    if not (node.is_on and machine.dialect.keeps_precondition):
        node.is_on = holds(node.scripts["if"], node.board, machine.dialect.has_real_truth)
        if not node.is_on:
            return otherwise
    result = execute_tick(machine, node.child)
    if result in (SUCCESS, FAILURE):
        reset_child(machine, node.child)
        node.is_on = False
    return result


# ---- loops over a queue ----


def tick_loop(machine: Machine, node: SimulatedNode) -> int:
    """The child for each item of a queue."""
    if node.status == IDLE:
        node.is_on = False
        if node.queue is None or machine.dialect.copies_queues:
            node.queue = _items(node)
    if not node.is_on:
        if not node.queue:
            result = read_status(node, "if_empty")
            if result is None:
                raise EngineError("bad expected access")
            return result
        item, node.queue = node.queue[0], node.queue[1:]
        write(node, "value", item, _item_type(node))
    if node.status == IDLE:
        set_status(machine, node, RUNNING)
    result = execute_tick(machine, node.child)
    node.is_on = result == RUNNING
    if result in (SUCCESS, FAILURE):
        reset_child(machine, node.child)
    return FAILURE if result == FAILURE else RUNNING


def _items(node: SimulatedNode) -> tuple[Value, ...]:
    """The items of the queue."""
    written = node.ports.get("queue", "")
    if key_of(written, "queue") is not None:
        value = read(node, "queue")
        if not isinstance(value, str):
            raise NotModelled(f"the queue {written} of {node.path} is an entry without a text")
        written = value
    type_ = _item_type(node)
    return tuple([parsed(item, type_) for item in written.split(";")]) if written else ()


def _item_type(node: SimulatedNode) -> str:
    """The type of the items, which is that of the port for them."""
    return next(port.type for port in BUILTINS[node.id].ports if port.name == "value")


# ---- entries that were written ----


def tick_skip_unless_updated(machine: Machine, node: SimulatedNode) -> int:
    """The child if an entry was written since the last time; else SKIPPED."""
    return _if_updated(machine, node, SKIPPED)


def tick_wait_value_update(machine: Machine, node: SimulatedNode) -> int:
    """The child once an entry was written since the last time; till then RUNNING."""
    return _if_updated(machine, node, RUNNING)


def _if_updated(machine: Machine, node: SimulatedNode, otherwise: int) -> int:
    if not node.is_on and not sees_update(node):
        return otherwise
    result = execute_tick(machine, node.child)
    node.is_on = result == RUNNING
    return result


def sees_update(node: SimulatedNode) -> bool:
    """Whether the entry of a node was written since it looked last."""
    written = node.ports.get("entry", "")
    entry = node.board.entry(key_of(written, "entry") or written)
    if entry is None:
        return False
    before, node.seen = node.seen, entry.number
    return before != entry.number


def halt_updated(machine: Machine, node: SimulatedNode) -> None:
    """Forget that the child runs; before 4.9 neither it nor the node itself is reset."""
    node.is_on = False
    if machine.dialect.halts_updated_child:
        halt_children(machine, node)


# ---- subtrees ----


def tick_subtree(machine: Machine, node: SimulatedNode) -> int:
    """The root of the tree."""
    if node.status == IDLE:
        set_status(machine, node, RUNNING)
    result = execute_tick(machine, node.child)
    if result in (SUCCESS, FAILURE):
        reset_child(machine, node.child)
    return result
