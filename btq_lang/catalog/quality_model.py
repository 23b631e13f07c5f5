"""The rows of the quality catalog: both editions of ISO/IEC 25010, and what robotics and ISO/IEC 25059 add.

One invariant: names are facts of the standards, definitions are in words of our own.  An id is lower case, words joined
by `-`, characteristic and sub-characteristic by `.`; the name is made from it.  Look-up is in `qualities`, other words
for a quality in `quality_words`.

A model is an outline: characteristics with their definitions, and indented below each its sub-characteristics: the rest
of the id, and its definition.  A line that is too long for the page goes on after a backslash.
"""

from __future__ import annotations

from typing import Final, Literal

# ISO/IEC 25010:2023, the product quality model.
PRODUCT_2023: Final = """\
functional-suitability: Ability of the product to offer functions that meet the stated and implied needs of its \
        intended users.
    functional-completeness: The set of functions covers every task and every goal of the intended users.
    functional-correctness: Intended users get accurate results.
    functional-appropriateness: The functions make it easy to accomplish the specified tasks and goals.
performance-efficiency: Ability of the product to do its functions within given time and throughput limits and with an \
        economical use of resources.
    time-behaviour: Response time and throughput meet the requirement.
    resource-utilization: No more than the agreed amount of each resource is used.
    capacity: Maximum limits of the product meet the requirement.
compatibility: Ability of the product to exchange information with others and to do its work while sharing an \
        environment with them.
    co-existence: It works efficiently in a shared environment without harming other products.
    interoperability: It exchanges information with other products and the exchanged information is used on both sides.
interaction-capability: Ability of the product to let intended users exchange information with it through its \
        interface so that they complete their tasks in varied contexts (2011: usability).
    appropriateness-recognizability: Users can recognize whether the product suits their needs.
    learnability: Intended users can learn its functions within a given time.
    operability: Its functions and attributes make it easy to operate and control.
    user-error-protection: It prevents operating errors.
    user-engagement: It presents functions and information in an inviting, motivating way, so that people keep \
        interacting (2011: user interface aesthetics).
    inclusivity: People of varied backgrounds (age, ability, culture, language, gender, means) can use it.
    user-assistance: People with the widest range of characteristics and abilities can reach their goals with it, \
        thanks to fitting support (one half of 2011 accessibility).
    self-descriptiveness: It shows what it can do and how to use it, so that no manual or help desk is needed.
reliability: Ability of the product to do its functions without interruption or failure under given conditions for a \
        given time.
    faultlessness: It works without a fault in normal operation (2011: maturity).
    availability: It is operational and accessible when it is needed.
    fault-tolerance: It operates as intended in spite of hardware or software faults.
    recoverability: After an interruption or failure it recovers the affected data and the wanted state.
security: Ability of the product to protect information and data according to each party's authorization and to defend \
        against attacks.
    confidentiality: Only those authorized can access the data.
    integrity: State and data are protected from unauthorized change or deletion, whether by malice or by a computer \
        error.
    non-repudiation: Actions and events can be proven to have happened, so they cannot be denied later.
    accountability: Actions of an entity can be traced to that entity alone.
    authenticity: It can be proven that a subject or resource is who or what it claims to be.
    resistance: It keeps operating while a malicious party attacks it.
maintainability: Ability of the product to be modified effectively and efficiently by its intended maintainers.
    modularity: A change to one component has little effect on the others.
    reusability: It can serve as an asset in more than one system or in building other assets.
    analysability: The impact of an intended change, the cause of a failure and the parts to modify can be found \
        effectively.
    modifiability: It can be changed without adding defects or lowering its quality.
    testability: Objective, feasible tests can be designed and run to see whether a requirement is met.
flexibility: Ability of the product to be adapted to changes in requirements, contexts of use or system environment \
        (2011: portability).
    adaptability: It can be adapted or transferred to different hardware, software or usage environments.
    scalability: It copes with growing or shrinking workloads, or its capacity can be adjusted to them.
    installability: It can be installed and uninstalled effectively in the specified environments.
    replaceability: It can replace another product for the same purpose in the same environment.
safety: Ability of the product to avoid states that endanger human life, health, property or the environment under \
        defined conditions.
    operational-constraint: When it meets an operational hazard it restricts itself to safe parameters or states (for \
        example a speed cap near people).
    risk-identification: It notices courses of events or operations that could expose life, property or environment to \
        unacceptable risk.
    fail-safe: On a failure it puts itself into a safe mode or returns to a safe condition.
    hazard-warning: It warns operators or internal controls of unacceptable risks early enough for them to react.
    safe-integration: It stays safe during and after integration with other components.
"""

# ISO/IEC 25019:2023, the quality-in-use model.
IN_USE_2023: Final = """\
beneficialness: How much benefit results from using the product, system or service.
    usability: Specified users reach specified goals with effectiveness, efficiency and satisfaction in a specified \
        context.
    accessibility: People with the widest range of needs and abilities can use it to reach their goals in the \
        identified contexts.
    suitability: Its behaviour and outcomes in use meet the specified quality requirements.
freedom-from-risk: How far it reduces risks to economy, life, health, society, enterprise or environment.
    freedom-from-economic-risk: It reduces risk to finances, efficient operation, property or reputation.
    freedom-from-environmental-and-societal-risk: It reduces risk to the environment and to society at large.
    freedom-from-health-risk: It reduces risk to people's health.
    freedom-from-human-life-risk: It reduces risk to people's lives.
acceptability: How favourably people respond when they adopt and use it.
    experience: Users and stakeholders build up knowledge and skill over time.
    trustworthiness: Stakeholders can verify that their expectations are met and therefore have confidence.
    compliance: Stakeholders are confident that rules and laws are met in use.
"""

# ISO/IEC 25010:2011, the product quality model.
PRODUCT_2011: Final = """\
functional-suitability: How well what the product does matches the stated and implied needs in the conditions it is \
        meant for.
    functional-completeness: No task or user goal that was asked for is left without a function that serves it.
    functional-correctness: Results are right and as precise as needed.
    functional-appropriateness: The functions really help to get the task done, without needless steps.
performance-efficiency: How much is achieved for the time and resources spent under given conditions.
    time-behaviour: Response times, processing times and throughput stay within what was required.
    resource-utilization: The kinds and amounts of resources used (CPU, memory, energy, network, consumables) stay \
        within what was required.
    capacity: The upper limits of the product (users, items, payload, data rate) are as high as required.
compatibility: How well the product works beside and together with others in a shared hardware or software environment.
    co-existence: It does its job while sharing resources with other products and without harming them.
    interoperability: It can exchange information with other products and both sides can use what was exchanged.
usability: How effectively, efficiently and satisfyingly the intended users reach their goals with the product in a \
        given context.
    appropriateness-recognizability: Users can tell whether the product is the right one for their need.
    learnability: Intended users can learn to use it effectively, safely and with satisfaction.
    operability: It is easy to operate and to control.
    user-error-protection: It keeps users from making mistakes.
    user-interface-aesthetics: Its interface is pleasant and satisfying to work with.
    accessibility: People with the widest range of abilities and characteristics can reach their goal with it.
reliability: How dependably the product keeps doing its functions under given conditions for a given time.
    maturity: It meets the need for reliability in normal operation.
    availability: It is up and reachable whenever it is needed.
    fault-tolerance: It keeps working as intended although hardware or software faults are present.
    recoverability: After an interruption or failure it restores its data and gets back to the wanted state.
security: How well information and data are protected, so that everyone gets only the access they are entitled to.
    confidentiality: Data can be reached only by those allowed to see it.
    integrity: Programs and data are protected from unauthorized access or change.
    non-repudiation: It can be proven that an action or event took place, so nobody can deny it later.
    accountability: Every action can be traced to exactly the entity that did it.
    authenticity: The claimed identity of a person or resource can be proven.
maintainability: How effectively and efficiently the product can be improved, corrected or adapted by those meant to \
        maintain it.
    modularity: It is built of separate parts, so that changing one hardly touches the others.
    reusability: Parts of it can be used in other systems or to build other assets.
    analysability: It is easy to find causes of failures, parts to change and the impact of a change.
    modifiability: It can be changed without introducing defects or losing quality.
    testability: Test criteria can be set for it, and tests can show whether they are met.
portability: How effectively and efficiently the product can be moved to another hardware, software or operating \
        environment.
    adaptability: It can be fitted to different or changing environments.
    installability: It can be installed and removed in a given environment.
    replaceability: It can take the place of another product that serves the same purpose.
"""

# ISO/IEC 25010:2011, the quality-in-use model.
IN_USE_2011: Final = """\
effectiveness: How accurately and completely users reach their goals.
    effectiveness: How accurately and completely users reach their goals.
efficiency: What users spend (time, effort, money) for the goals they reach.
    efficiency: What users spend (time, effort, money) for the goals they reach.
satisfaction: How far users' needs are satisfied when the product is used in its context.
    usefulness: Users are content with the practical goals they reach and with the consequences of use.
    trust: Stakeholders are confident that the product will behave as intended.
    pleasure: Users enjoy having their personal needs fulfilled.
    comfort: Users are content with physical comfort.
freedom-from-risk: How far the product reduces risk to money, life, health or environment.
    economic-risk-mitigation: It reduces risk to financial status, operation, property, reputation or other resources.
    health-and-safety-risk-mitigation: It reduces risk to people.
    environmental-risk-mitigation: It reduces risk to property or the environment.
context-coverage: How far it can be used well and safely in the specified contexts and beyond them.
    context-completeness: It works well in every specified context of use.
    flexibility: It works well in contexts beyond those first specified.
"""

# Qualities that roboticists need beside the standards, and below each the nearest of the 2023 edition, and what to
# measure.
ROBOTICS: Final = """\
energy-autonomy: How long or how far the robot can work before it must recharge.
    performance-efficiency.resource-utilization: battery level, energy per task, range, time to empty
motion-quality: Velocity, acceleration, jerk and smoothness of movements stay in the wanted range.
    safety.operational-constraint: speed, acceleration, jerk
pose-accuracy: Closeness of the reached pose to the commanded one (ISO 18646-2, ISO 9283).
    functional-suitability.functional-correctness: position error, heading error
pose-repeatability: Spread of reached poses over repeated attempts (ISO 18646-2, ISO 9283).
    functional-suitability.functional-correctness: standard deviation of position error
human-separation: Distance between robot and people never falls below the protective distance (ISO/TS 15066, ISO \
        10218-2:2025).
    safety.operational-constraint: separation distance, relative speed
contact-force-limit: Forces and pressures on contact stay below the biomechanical limits (ISO/TS 15066, ISO \
        10218-2:2025).
    safety.operational-constraint: contact force, contact pressure
stopping-performance: Time and distance the robot needs to stop (ISO 18646-1, ISO 10218-1).
    safety.fail-safe: stopping time, stopping distance
ergonomics: Work with the robot is physically and mentally comfortable for people (named by a survey participant).
    interaction-capability: posture score, hand-over time, noise
comfort: People near or served by the robot feel at ease.
    interaction-capability.user-engagement: approach speed, passing distance, noise level
legibility: People can tell from the motion what the robot intends.
    interaction-capability.self-descriptiveness: time until intent is recognized
predictability: The robot behaves as people expect.
    interaction-capability.self-descriptiveness: deviation from announced path
explainability: The robot can say why it did or did not do something.
    interaction-capability.self-descriptiveness: share of decisions with an explanation
transparency: Fitting information about the system is given to its stakeholders (ISO/IEC 25059).
    interaction-capability.self-descriptiveness:
trust: People rely on the robot to a degree that fits its real abilities.
    interaction-capability: survey score, take-over rate
social-acceptability: People accept the robot and its behaviour around them.
    interaction-capability.user-engagement: survey score
controllability: A person can step in and take over in time (user controllability and intervenability in ISO/IEC 25059).
    interaction-capability.operability: take-over latency
autonomy: Share of the mission done without human help.
    functional-suitability: interventions per hour, mission success without help
dependability: Umbrella term: availability, reliability, safety, integrity, maintainability.
    reliability: mission success rate, MTBF
resilience: The mission is completed in spite of disturbances, possibly in a degraded mode.
    reliability.fault-tolerance: recoveries per mission, success after fault
mission-success: Share of missions that reach their goal.
    reliability.faultlessness: success rate
reactivity: Time from an external event to the fitting behaviour.
    performance-efficiency.time-behaviour: reaction latency
coverage: Share of the area or items that was served.
    functional-suitability.functional-completeness: covered area
perception-quality: Detections are right and timely.
    functional-suitability.functional-correctness: precision, recall, detection latency
localization-quality: The robot knows where it is.
    functional-suitability.functional-correctness: pose covariance, localization error
privacy: Data about people is collected, kept and shared only as allowed.
    security.confidentiality: data sink, retention time
noise-emission: Sound level of the robot.
    performance-efficiency.resource-utilization: sound pressure level
wear: Mechanical and battery wear caused by the mission.
    performance-efficiency.resource-utilization: charge cycles, actuator load
sustainability: Energy, material and emissions over the life cycle.
    performance-efficiency.resource-utilization: energy per task
ethics: The behaviour respects norms and rights of the people concerned (25059: societal and ethical risk mitigation).
    safety:
configurability: The robot can be set up for other tasks or sites (a system ability in the euRobotics roadmap).
    flexibility.adaptability:
"""

# What a name of 2011 became in 2023, if it is not the same; empty: it was dropped without a replacement.
SUCCESSORS: Final[dict[str, tuple[str, ...]]] = {
    "usability": ("interaction-capability",),
    "usability.appropriateness-recognizability": ("interaction-capability.appropriateness-recognizability",),
    "usability.learnability": ("interaction-capability.learnability",),
    "usability.operability": ("interaction-capability.operability",),
    "usability.user-error-protection": ("interaction-capability.user-error-protection",),
    "usability.user-interface-aesthetics": ("interaction-capability.user-engagement",),
    "usability.accessibility": ("interaction-capability.inclusivity", "interaction-capability.user-assistance"),
    "reliability.maturity": ("reliability.faultlessness",),
    "portability": ("flexibility",),
    "portability.adaptability": ("flexibility.adaptability",),
    "portability.installability": ("flexibility.installability",),
    "portability.replaceability": ("flexibility.replaceability",),
    "effectiveness": ("beneficialness.usability",),
    "efficiency": ("beneficialness.usability",),
    "satisfaction": ("beneficialness.usability", "acceptability"),
    "satisfaction.trust": ("acceptability.trustworthiness",),
    "satisfaction.usefulness": ("beneficialness.suitability",),
    "satisfaction.pleasure": ("acceptability.experience",),
    "satisfaction.comfort": (),
    "freedom-from-risk.economic-risk-mitigation": ("freedom-from-risk.freedom-from-economic-risk",),
    "freedom-from-risk.health-and-safety-risk-mitigation": (
        "freedom-from-risk.freedom-from-health-risk",
        "freedom-from-risk.freedom-from-human-life-risk",
    ),
    "freedom-from-risk.environmental-risk-mitigation": (
        "freedom-from-risk.freedom-from-environmental-and-societal-risk",
    ),
    "context-coverage": (),
}

# ISO/IEC 25059:2023 adds these for systems with artificial intelligence, below characteristics of the 2011 edition.
AI: Final = """\
functional-suitability:
    functional-adaptability: It learns from data or from what happened before and does better by it.
usability:
    user-controllability: A person can step into what the system does in time.
    transparency: Users get fitting information about the system.
reliability:
    robustness: It keeps its correctness under whatever conditions it meets.
security:
    intervenability: An operator can step in before harm is done.
freedom-from-risk:
    societal-and-ethical-risk-mitigation: It reduces risk to society and to what people hold right.
satisfaction:
    transparency: Stakeholders are content with the information that they get about the system.
"""

# Names that are not the id's words with blanks.
NAMES: Final = {
    "co-existence": "Co-existence",
    "non-repudiation": "Non-repudiation",
    "self-descriptiveness": "Self-descriptiveness",
}

# Every model of the ISO: edition, kind, standard, outline.
MODELS: Final[tuple[tuple[Literal["2011", "2023"], Literal["product", "in-use"], str, str], ...]] = (
    ("2023", "product", "ISO/IEC 25010:2023", PRODUCT_2023),
    ("2023", "in-use", "ISO/IEC 25019:2023", IN_USE_2023),
    ("2011", "product", "ISO/IEC 25010:2011", PRODUCT_2011),
    ("2011", "in-use", "ISO/IEC 25010:2011", IN_USE_2011),
)

# The successors of these are only similar: merged into something wider, or the closest there is.
NO_EQUAL: Final = frozenset(
    (
        "effectiveness",
        "efficiency",
        "satisfaction",
        "satisfaction.trust",
        "satisfaction.usefulness",
        "satisfaction.pleasure",
        "freedom-from-risk.environmental-risk-mitigation",
    )
)
