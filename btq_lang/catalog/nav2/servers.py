"""The parameters of Nav2's other nodes; `tools/nav2_servers.py` writes this file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

# By node: the first letters of the distributions that read them, and their names, of `a.b` only `a`; without those of
# the plugins that a node loads.
SERVERS: Final[Mapping[str, Mapping[str, str]]] = {
    "amcl": {
        "hijkl": (
            "alpha1 alpha2 alpha3 alpha4 alpha5 always_reset_initial_pose base_frame_id beam_skip_distance "
            "beam_skip_error_threshold beam_skip_threshold do_beamskip first_map_only global_frame_id initial_pose "
            "lambda_short laser_likelihood_max_dist laser_max_range laser_min_range laser_model_type map_topic "
            "max_beams max_particles min_particles odom_frame_id pf_err pf_z recovery_alpha_fast recovery_alpha_slow "
            "resample_interval robot_model_type save_pose_rate scan_topic set_initial_pose sigma_hit tf_broadcast "
            "transform_tolerance update_min_a update_min_d z_hit z_max z_rand z_short"
        ),
        "jkl": "freespace_downsampling",
        "l": "allow_parameter_qos_overrides initialize_at_saved_pose random_seed saved_pose_filepath",
    },
    "behavior_server": {
        "h": "costmap_topic footprint_topic",
        "hijkl": "behavior_plugins cycle_frequency global_frame robot_base_frame transform_tolerance",
        "ij": "action_server_result_timeout",
        "ijkl": "global_costmap_topic global_footprint_topic local_costmap_topic local_footprint_topic local_frame",
        "jkl": "enable_stamped_cmd_vel",
    },
    "collision_monitor": {
        "hijkl": (
            "base_frame_id base_shift_correction cmd_vel_in_topic cmd_vel_out_topic observation_sources odom_frame_id "
            "polygons source_timeout stop_pub_timeout transform_tolerance"
        ),
        "ijkl": "frequency state_topic use_realtime_priority",
        "jkl": "enable_stamped_cmd_vel",
        "l": "collision_points_marker_3d enabled",
    },
    "controller_server": {
        "hi": "progress_checker_plugin",
        "hijkl": (
            "controller_frequency controller_plugins failure_tolerance goal_checker_plugins "
            "min_theta_velocity_threshold min_x_velocity_threshold min_y_velocity_threshold speed_limit_topic"
        ),
        "hjkl": "publish_zero_velocity",
        "ij": "action_server_result_timeout",
        "ijkl": "progress_checker_plugins use_realtime_priority use_sim_time",
        "jkl": "costmap_update_timeout enable_stamped_cmd_vel",
        "l": "odom_duration odom_topic path_handler_plugins search_window",
    },
    "costmap_filter_info_server": {
        "hijkl": "base filter_info_topic mask_topic multiplier type",
    },
    "docking_server": {
        "j": "action_server_result_timeout",
        "jkl": (
            "base_frame controller controller_frequency dock_approach_timeout dock_backwards dock_database "
            "dock_plugins dock_prestaging_tolerance docks enable_stamped_cmd_vel fixed_frame "
            "initial_perception_timeout max_retries navigator_bt_xml undock_angular_tolerance undock_linear_tolerance "
            "wait_charge_timeout"
        ),
        "kl": "odom_topic rotate_to_dock_timeout rotation_angular_tolerance",
        "l": "odom_duration",
    },
    "lifecycle_manager": {
        "hijkl": "attempt_respawn_reconnection autostart bond_respawn_max_duration bond_timeout node_names",
        "kl": "service_timeout",
        "l": "bond_heartbeat_period",
    },
    "map_saver": {
        "hijkl": "free_thresh_default map_subscribe_transient_local occupied_thresh_default save_map_timeout",
    },
    "map_server": {
        "hijkl": "frame_id topic_name yaml_filename",
    },
    "planner_server": {
        "hijkl": "expected_planner_frequency planner_plugins",
        "ij": "action_server_result_timeout",
        "ijkl": "use_sim_time",
        "jkl": "costmap_update_timeout",
        "l": "allow_partial_planning",
    },
    "route_server": {
        "hj": "global_frame",
        "hjkl": (
            "aggregate_blocked_ids base_frame boundary_radius_to_achieve_node costmap_topic edge_cost_functions "
            "enable_nn_search graph_file_loader graph_file_saver graph_filepath max_iterations "
            "max_nn_search_iterations max_planning_time max_prune_dist_from_edge min_prune_dist_from_goal "
            "min_prune_dist_from_start num_nearest_nodes operations path_density prune_goal radius_to_achieve_node "
            "route_frame smooth_corners smoothing_radius tracker_update_rate"
        ),
        "j": "action_server_result_timeout",
        "l": "smoothing_angle_threshold",
    },
    "smoother_server": {
        "hijkl": "costmap_topic footprint_topic robot_base_frame smoother_plugins transform_tolerance",
        "ij": "action_server_result_timeout",
    },
    "velocity_smoother": {
        "hijkl": (
            "deadband_velocity feedback max_accel max_decel max_velocity min_velocity odom_duration odom_topic "
            "scale_velocities smoothing_frequency velocity_timeout"
        ),
        "ijkl": "use_realtime_priority",
        "j": "stamp_smoothed_velocity_with_smoothing_time",
        "jkl": "enable_stamped_cmd_vel",
    },
    "waypoint_follower": {
        "hijkl": "loop_rate stop_on_failure waypoint_task_executor_plugin",
        "ij": "action_server_result_timeout",
        "ijkl": "global_frame_id",
    },
}
