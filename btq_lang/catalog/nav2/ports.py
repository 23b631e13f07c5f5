"""The ports that each node of Nav2 has in any distribution; tools/nav2_nodes.py writes this file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

PORTS: Final[Mapping[str, str]] = {
    "AppendGoalPoseToGoals": "goal_pose input_goals output_goals",
    "AreErrorCodesPresent": "error_code error_codes_to_check",
    "ArePosesNear": "global_frame ref_pose target_pose tolerance",
    "AssistedTeleop": "error_code_id error_msg is_recovery server_name server_timeout time_allowance",
    "BackUp": "backup_dist backup_speed disable_collision_checks error_code_id error_msg server_name server_timeout"
    " time_allowance",
    "CancelAssistedTeleop": "server_name server_timeout",
    "CancelBackUp": "server_name server_timeout",
    "CancelComputeAndTrackRoute": "server_name server_timeout",
    "CancelControl": "server_name server_timeout",
    "CancelDriveOnHeading": "server_name server_timeout",
    "CancelFollowObject": "server_name server_timeout",
    "CancelSpin": "server_name server_timeout",
    "CancelWait": "server_name server_timeout",
    "CheckPoseOccupancy": "consider_unknown_as_obstacle cost_threshold pose server_timeout service_name use_footprint",
    "CheckStopStatus": "duration_stopped velocity_threshold",
    "ClearCostmapAroundPose": "plugins pose reset_distance server_timeout service_name",
    "ClearCostmapAroundRobot": "plugins reset_distance server_timeout service_name",
    "ClearCostmapExceptRegion": "plugins reset_distance server_timeout service_name",
    "ClearEntireCostmap": "plugins server_timeout service_name",
    "ComputeAndTrackRoute": "current_edge_id error_code_id error_msg execution_duration goal goal_id last_node_id"
    " next_node_id path rerouted route server_name server_timeout start start_id use_poses"
    " use_start",
    "ComputePathThroughPoses": "error_code_id error_msg goals last_reached_index path planner_id server_name"
    " server_timeout start",
    "ComputePathToPose": "error_code_id error_msg goal path planner_id server_name server_timeout start use_start"
    " viapoints",
    "ComputeRoute": "error_code_id error_msg goal goal_id path planning_time route server_name server_timeout start"
    " start_id use_poses use_start",
    "ConcatenatePaths": "input_path1 input_path2 output_path",
    "ControllerSelector": "default_controller selected_controller topic_name",
    "DistanceController": "distance global_frame robot_base_frame",
    "DistanceTraveled": "distance global_frame robot_base_frame",
    "DockRobot": "dock_id dock_pose dock_type error_code_id error_msg max_staging_time navigate_to_staging_pose"
    " num_retries server_name server_timeout success use_dock_id",
    "DriveOnHeading": "disable_collision_checks dist_to_travel error_code_id error_msg server_name server_timeout"
    " speed time_allowance",
    "ExtractRouteNodesAsGoals": "goals route",
    "FollowObject": "error_code_id error_msg max_duration pose_topic server_name server_timeout total_elapsed_time"
    " tracked_frame",
    "FollowPath": "controller_id error_code_id error_msg goal_checker_id path path_handler_id progress_checker_id"
    " server_name server_timeout tracking_feedback",
    "GetCurrentPose": "current_pose global_frame robot_base_frame",
    "GetNextFewGoals": "input_goals num_goals output_goals",
    "GetPoseFromPath": "index path pose",
    "GlobalUpdatedGoal": "goal goals",
    "GoalCheckerSelector": "default_goal_checker selected_goal_checker topic_name",
    "GoalReached": "global_frame goal robot_base_frame",
    "GoalUpdated": "goal goals",
    "GoalUpdatedController": "goal goals",
    "GoalUpdater": "input_goal input_goals output_goal output_goals",
    "InitialPoseReceived": "initial_pose_received",
    "IsBatteryCharging": "battery_topic",
    "IsBatteryLow": "battery_topic is_voltage min_battery",
    "IsGoalNearby": "global_frame max_robot_pose_search_dist path proximity_threshold robot_base_frame",
    "IsPathValid": "consider_unknown_as_obstacle max_cost path server_timeout",
    "IsStopped": "duration_stopped velocity_threshold",
    "IsStuck": "",
    "IsWithinPathTrackingBounds": "max_error_heading max_error_left max_error_right tracking_feedback",
    "NavigateThroughPoses": "behavior_tree error_code_id error_msg goals server_name server_timeout",
    "NavigateToPose": "behavior_tree error_code_id error_msg goal server_name server_timeout",
    "NonblockingSequence": "",
    "PathExpiringTimer": "path seconds",
    "PathHandlerSelector": "default_path_handler selected_path_handler topic_name",
    "PathLongerOnApproach": "length_factor path prox_len",
    "PauseResumeController": "pause_service_name resume_service_name",
    "PersistentSequence": "current_child_idx",
    "PipelineSequence": "",
    "PlannerSelector": "default_planner selected_planner topic_name",
    "ProgressCheckerSelector": "default_progress_checker selected_progress_checker topic_name",
    "RateController": "hz",
    "RecoveryNode": "number_of_retries",
    "ReinitializeGlobalLocalization": "server_timeout service_name",
    "RemoveInCollisionGoals": "consider_unknown_as_obstacle cost_threshold input_goals input_waypoint_statuses"
    " output_goals output_waypoint_statuses server_timeout service_name use_footprint",
    "RemovePassedGoals": "global_frame input_goals input_waypoint_statuses output_goals output_waypoint_statuses"
    " radius robot_base_frame",
    "RoundRobin": "wrap_around",
    "SingleTrigger": "",
    "SmoothPath": "check_for_collisions error_code_id error_msg max_smoothing_duration server_name server_timeout"
    " smoothed_path smoother_id smoothing_duration unsmoothed_path was_completed",
    "SmootherSelector": "default_smoother selected_smoother topic_name",
    "SpeedController": "goal goals max_rate max_speed min_rate min_speed",
    "Spin": "disable_collision_checks error_code_id error_msg is_recovery server_name server_timeout spin_dist"
    " time_allowance",
    "TimeExpired": "seconds",
    "ToggleCollisionMonitor": "enable server_timeout service_name",
    "TransformAvailable": "child parent",
    "TruncatePath": "distance input_path output_path",
    "TruncatePathLocal": "angular_distance_weight distance_backward distance_forward input_path"
    " max_robot_pose_search_dist output_path pose robot_base_frame robot_frame transform_tolerance",
    "UndockRobot": "dock_type error_code_id error_msg max_undocking_time server_name server_timeout success",
    "ValidatePath": "collision_poses consider_unknown_as_obstacle footprint layer_name max_cost max_lookahead_distance"
    " path server_timeout service_name stop_at_first_collision",
    "Wait": "error_code_id error_msg server_name server_timeout wait_duration",
    "WouldAControllerRecoveryHelp": "error_code error_codes_to_check",
    "WouldAPlannerRecoveryHelp": "error_code error_codes_to_check",
    "WouldARouteRecoveryHelp": "error_code error_codes_to_check",
    "WouldASmootherRecoveryHelp": "error_code error_codes_to_check",
}
