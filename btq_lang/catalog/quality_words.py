"""Words for qualities other than their names: the paper's spellings, synonyms, words that mean several things.

One invariant: everything here leads to ids of `quality_model`, of the 2023 edition where the editions differ.
"""

from __future__ import annotations

from typing import Final

# The published paper writes `performance <time-behavior>`: these pairs are good names.
PAPER_NAMES: Final = {
    ("performance", "time-behavior"): "performance-efficiency.time-behaviour",
    ("performance", "resource-utilization"): "performance-efficiency.resource-utilization",
    ("security", "confidentiality"): "security.confidentiality",
}

# Other words for a quality of the 2023 edition, blanks as `-`.
ALIASES: Final = {
    "performance-efficiency": "performance",
    "performance-efficiency.time-behaviour": (
        "speed time timing latency response-time responsiveness throughput timeliness duration real-time"
    ),
    "performance-efficiency.resource-utilization": (
        "resource-use resource-usage resource-consumption resource-efficiency memory cpu-load energy energy-efficiency "
        "power battery battery-consumption power-consumption"
    ),
    "performance-efficiency.capacity": "payload load-capacity",
    "functional-suitability": "functionality",
    "functional-suitability.functional-completeness": "completeness",
    "functional-suitability.functional-correctness": "correctness accuracy precision repeatability",
    "functional-suitability.functional-appropriateness": "appropriateness",
    "compatibility.interoperability": "interop integration",
    "interaction-capability": "ease-of-use user-experience ux human-robot-interaction hri user-friendliness",
    "interaction-capability.appropriateness-recognizability": "recognizability",
    "interaction-capability.operability": "user-controllability",
    "interaction-capability.user-engagement": "aesthetics ui-aesthetics engagement",
    "interaction-capability.inclusivity": "inclusiveness inclusion",
    "interaction-capability.user-error-protection": "error-protection",
    "reliability.faultlessness": "mtbf",
    "reliability.fault-tolerance": "failure-tolerance",
    "reliability.availability": "uptime",
    "reliability.recoverability": "recovery mttr",
    "security": "cybersecurity information-security",
    "security.confidentiality": "data-protection secrecy",
    "security.accountability": "traceability auditability",
    "security.authenticity": "authentication",
    "security.resistance": "attack-resistance immunity",
    "maintainability": "maintenance",
    "maintainability.analysability": "diagnosability debuggability",
    "maintainability.modifiability": "changeability extensibility evolvability",
    "maintainability.modularity": "composability",
    "maintainability.testability": "verifiability",
    "flexibility.adaptability": "adaptivity",
    "flexibility.installability": "deployability",
    "flexibility.replaceability": "interchangeability",
    "flexibility.scalability": "elasticity",
    "safety": "physical-safety human-safety functional-safety",
    "safety.fail-safe": "fail-safety safe-state",
    "safety.hazard-warning": "warning alarm",
    "safety.operational-constraint": "speed-limit safety-constraint collision-avoidance obstacle-avoidance",
    "safety.risk-identification": "risk hazard-detection",
}

# Words that mean several things: an explanation, and the meanings, the likeliest first; an edition has some of them.
AMBIGUOUS: Final = {
    "usability": (
        "in 2011 a characteristic of the product, which 2023 calls interaction capability; since 2023 a part of "
        "beneficialness, a quality in use",
        ("interaction-capability", "beneficialness.usability"),
    ),
    "accessibility": (
        "in 2011 a part of usability, which 2023 splits into user assistance and inclusivity; since 2023 also a part "
        "of beneficialness, a quality in use",
        (
            "interaction-capability.user-assistance",
            "interaction-capability.inclusivity",
            "beneficialness.accessibility",
        ),
    ),
    "flexibility": (
        "in 2023 a characteristic of the product, which 2011 calls portability; in 2011 a part of context coverage, a "
        "quality in use",
        ("flexibility", "context-coverage.flexibility"),
    ),
    "efficiency": (
        "short for performance efficiency, or in 2011 a quality in use that 2023 folds into usability",
        ("performance-efficiency", "beneficialness.usability"),
    ),
    "integrity": (
        "here a part of security; texts on dependability mean the absence of wrong changes of state",
        ("security.integrity",),
    ),
    "availability": (
        "here a part of reliability; elsewhere one of the three aims of security",
        ("reliability.availability",),
    ),
    "safety": (
        "in 2023 a characteristic of the product; 2011 has only freedom from risk, a quality in use",
        ("safety", "freedom-from-risk.health-and-safety-risk-mitigation"),
    ),
    "robustness": (
        "not defined by ISO/IEC 25010: robotics texts usually mean fault tolerance, ISO/IEC 25059 has it as a part of "
        "reliability for systems with artificial intelligence",
        ("reliability.fault-tolerance", "reliability.robustness"),
    ),
    "suitability": (
        "short for functional suitability, or since 2023 a part of beneficialness, a quality in use",
        ("functional-suitability", "beneficialness.suitability"),
    ),
    "trust": (
        "here the trust of people in the robot; in 2011 also a part of satisfaction, in 2023 trustworthiness is a part "
        "of acceptability, both qualities in use",
        ("trust", "satisfaction.trust", "acceptability.trustworthiness"),
    ),
}
