"""A running robot, through the Groot2Publisher of BehaviorTree.CPP: a tree, transitions, and samples of its blackboard.

One invariant: nothing is asked that changes what the robot does; the publisher is made to record transitions, and never
gets a hook.  Whatever comes over the network, the answer is a session, a note in words, or the wait for better.

    messages.py    requests and replies as bytes
    publisher.py   asks a publisher, through pyzmq
    following.py   the replies of a publisher, compared with those before: rows, gaps, other trees
    sessions.py    the sessions for the judge, from a thread that follows the publisher

Source: src/loggers/groot2_publisher.cpp and include/behaviortree_cpp/loggers/groot2_protocol.h.
"""
