"""A mission with one requirement of every kind."""

from __future__ import annotations

WORKED = """
signal battery : % from {battery_level} level fresh within 5 s initially 100 %
signal energy : Wh from {energy_used} counter
signal speed : m/s from {base_speed}
signal humans : person from {people_count}
context humans_near : humans > 0 person

QualityReq rq1 : time-behaviour "Reach the charging station in time"
    BatteryCheck/MoveBase takes at most 30 s
    on violation fail
QualityReq rq4 : reliability
    BatteryCheck/MoveBase succeeds within 30 s
    in at least 98 % of activations
    confidence 95 %
    over last 200 activations
QualityReq rq5 : energy-autonomy
    SolidStation uses at most 0.02 kWh of energy
    goal 15 Wh
QualityReq rq6 : time-behaviour
    from Pick starts to Place succeeds takes at most 45 s
QualityReq slow(limit : m/s = 0.25 m/s) : safety.operational-constraint
    keeps speed <= limit
    while humans_near
    on violation fail
    because "movement next to people"
apply slow to every MoveBase except BatteryCheck/MoveBase
apply slow(limit = 0.1 m/s) to PickPlace/Place
QualityReq fetch : time-behaviour
    GoToFridge takes at most 20 s if not humans_near else 30 s
QualityReq replan : time-behaviour
    ComputePathToPose runs at least 1 per 1 s
    while node FollowPath
QualityReq order : safety
    Place follows CheckClear succeeds
    on violation fail
QualityReq calm : ergonomics "People near the robot should not be startled"

Condition Sensors
    output battery : double
    output energy : double
    output speed : double
    output humans : double
Condition BatteryLow
Condition CheckClear
Action MoveBase
    input station : string
Action Charge
Action Pick
Action Place
Action GoToFridge
Action ComputePathToPose
Action FollowPath

BehaviorTree Main
    R->
        Sensors (
            battery = {@battery_level}
            energy = {@energy_used}
            speed = {@base_speed}
            humans = {@people_count}
        )
        -> Work
            -> BatteryCheck
                BatteryLow
                MoveBase (station = "charger")
                Charge
            -> SolidStation
                MoveBase (station = "solid")
                SubTree PickPlace
            GoToFridge satisfies calm
            ComputePathToPose
            FollowPath

BehaviorTree PickPlace
    ->
        Pick
        CheckClear
        Place
"""
