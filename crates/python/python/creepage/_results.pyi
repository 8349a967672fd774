"""Types of the documents, written by the test `python_types` of creepage-lib.

A number that is not finite is None.
"""

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from typing_extensions import NotRequired, TypedDict

# What a check found; `docs/checks.md` describes it. Numbers in SI units unless an entry says otherwise. What a file of another version lacks has its default.
CheckResult = TypedDict(
    "CheckResult",
    {
        "law": LawUsed,  # The friction law.
        "law_followed": LawFollowed,  # On which part of contact area and time the law's coefficient is known.
        "limits": dict[Measure, Limit | None],  # The limit of each measure; none where it has none.
        "limits_for": MethodKind,  # The kind of method that the limits are for.
        "mesh_mode": MeshModeFound,  # Slip that alternates from node to node.
        "metrics": dict[Measure, Metric],  # The measures.
        "name": str,  # Name of the run's case, else of its folder.
        "node_times": int,  # Nodes in contact, summed over the records.
        "nodes": int,  # Nodes of both surfaces.
        "notes": list[str],  # What could not be measured, and what to know of the rest.
        "pairing": PairingUsed,  # Which slip velocity a traction is paired with.
        "pass": bool,  # Whether every limit holds.
        "patch": dict[PatchMeasure, PatchMean],  # Means of the patch.
        "recorded": list[float],  # Times of the first and the last record in it (s).
        "scales": dict[str, ScaleUsed],  # The scales of the measures by their names.
        "slip_zone": SlipZoneFound | None,  # Slip over the slip zone; none where nothing slips.
        "steps": int,  # Number of these records.
        "tolerances": Tolerances,  # From where on a node is in contact or adhesion, and violates the law or the direction.
        "window": list[float],  # The window, from and to (s).
    },
)

# Errors of the solution that every run watches.
Checks = TypedDict(
    "Checks",
    {
        "cone_excess": float | None,  # largest (|shear| - mu pressure) over Hertz's peak pressure (1)
        "contact_damping": float | None,  # the part of damping_dissipated that contact took (J)
        "resultant_mismatch": float | None,  # |sum of the contact forces on both bodies| over the normal force (1)
    },
)

# Means over the evaluation window; forces are those of the bar on the disk in the global frame (x rolls, y is lateral, z is up). `None` (null) where there is no value, such as where Hertz's distribution fits no pressure.
Contact = TypedDict(
    "Contact",
    {
        "creepage": float | None,  # (omega R_eff - V)/V (1)
        "lateral_force": float | None,  # force of the bar on the disk, y, mean over the evaluation window (N)
        "nominal_creepage": float | None,  # (omega R - V)/V, with R the radius of the undeformed disk (1)
        "normal_force": float | None,  # force of the bar on the disk, z, mean over the evaluation window (N)
        "patch_area": float | None,  # area of the bar's nodes in contact (m2)
        "patch_area_fitted": float | None,  # area of the fitted ellipse, or of a line contact's rectangle (m2)
        "patch_half_length": float | None,  # half axis of the patch in x (m)
        "patch_half_width": float | None,  # half axis of the patch in y, or half the width of a line contact (m)
        "peak_pressure": float | None,  # largest pressure of the fit of Hertz's distribution (Pa)
        "slip_fraction": float | None,  # share of the patch that slips (1)
        "stick_fraction": float | None,  # share of the patch that sticks (1)
        "tangential_force": float | None,  # force of the bar on the disk, x, mean over the evaluation window (N)
        "traction_coefficient": float | None,  # tangential over normal force (1)
    },
)

# A statistic beside the value of a measure, in the unit of the measure unless it says otherwise.
Detail = Literal["mean", "median", "rms", "p95", "max", "rms_slip_state", "energy", "deviation_traction", "deviation_law", "deviation_slip", "mu_used", "mu_law", "mu_used_worst", "mu_law_worst", "uncertainty_median", "uncertainty_rms", "uncertainty_p95"]

# The energy balance of both bodies at the end of the run, and its error.
Energy = TypedDict(
    "Energy",
    {
        "balance_error": float,  # error of the energy balance, |sum of energies - external work - initial sum|, over the largest energy exchanged (1)
        "contact_stored": float,  # energy in the contact springs (J)
        "damping_dissipated": float,  # work of all dampers turned into heat so far (J)
        "external_work": float,  # work of prescribed motion and load so far (J)
        "friction_dissipated": float,  # work of friction turned into heat so far (J)
        "hourglass": float,  # energy of the hourglass stiffness (J)
        "internal": float,  # strain energy of the elements (J)
        "kinetic": float,  # kinetic energy (J)
    },
)

# What exact enforcement took.
ExactContact = TypedDict(
    "ExactContact",
    {
        "kelvin_voigt": float,  # Kelvin-Voigt time constant (s)
        "manifold_node_steps": int,  # nodes times steps at which friction had several solutions (1)
        "mortar_integrals": int,  # integrals of mortar rows (1)
        "most_sweeps": int,  # most sweeps of a step (1)
        "rows": str | None,  # `node_to_face` or `mortar`
        "steepness_node": float | None,  # largest steepness of friction of a node in an implicit step (1)
        "steepness_patch": float | None,  # the same of all nodes together (1)
        "unconverged_change": float | None,  # largest last change of a force over the largest force (1)
        "unconverged_steps": int,  # steps whose sweeps did not converge (1)
        "warnings": list[str],  # what did not converge
    },
)

# Length and CRC-32 of a file.
FileSum = TypedDict(
    "FileSum",
    {
        "bytes": int,  # Its length (bytes).
        "crc32": str,  # CRC-32 of its content, eight hexadecimal digits in lower case.
    },
)

# Files of a run, relative to its folder.
Files = TypedDict(
    "Files",
    {
        "contact": str,  # Both contact surfaces.
        "fields": str,  # Fields of both bodies; empty where the run has no such file.
        "history": str,  # Scalars over time.
        "postmortem": NotRequired[str | None],  # The state in which the guards stopped the run, if they did.
    },
)

# Hertz's contact of the case.
HalfSpace = TypedDict(
    "HalfSpace",
    {
        "approach": float | None,  # delta, Hertz's approach of the bodies; zero of a line contact, which has none (m)
        "area": float | None,  # area of Hertz's patch (m2)
        "half_length": float | None,  # a, half axis of Hertz's patch in x (m)
        "half_width": float | None,  # b, half axis of Hertz's patch in y (m)
        "peak_pressure": float | None,  # p_0, Hertz's peak pressure (Pa)
    },
)

# What implicit steps took.
Implicit = TypedDict(
    "Implicit",
    {
        "cut": int,  # implicit steps cut (1)
        "iterations": int,  # iterations of all implicit steps (1)
        "products": int,  # products with the stiffness of all implicit steps (1)
        "solved": int,  # implicit steps solved (1)
        "theta": float,  # parameter of the theta method (1)
    },
)

# Shares of contact area and time on which the law's coefficient is known.
LawFollowed = TypedDict(
    "LawFollowed",
    {
        "blurred": float | None,  # The same, by another name.
        "known": float | None,  # To round-off.
        "note": str | None,  # Why the law cannot be followed.
        "uncertain": float | None,  # To an interval.
        "unknown": float | None,  # Not at all.
    },
)

# The friction law of a check.
LawUsed = TypedDict(
    "LawUsed",
    {
        "bound": str,  # Which coefficient bounds the shear.
        "decay": NotRequired[float | None],  # Its decay (s/m).
        "dynamic": NotRequired[float | None],  # Coefficient at high slip velocity, as in Eq. (8).
        "law": str | None,  # Its word, of Coulomb's law and of those of the form of Eq. (8).
        "static": NotRequired[float | None],  # Coefficient at rest.
    },
)

# The limit of a measure.
Limit = float | list[float]

# A mean over the evaluation window.
Mean = Literal["normal_force", "tangential_force", "lateral_force", "traction_coefficient", "creepage", "patch_half_length", "patch_half_width", "patch_area", "patch_area_fitted", "peak_pressure", "stick_fraction", "slip_fraction", "stick_border", "peak_shear", "torque", "max_penetration", "hourglass_share", "friction_power"]

# A mean over the members of an ensemble of their means over time.
MeanOfMeans = TypedDict(
    "MeanOfMeans",
    {
        "ci95": float,  # Half the width of its 95 % confidence interval.
        "mean": float,  # The mean.
    },
)

# A mean over the members of an ensemble.
MeanValue = TypedDict(
    "MeanValue",
    {
        "ci95": float,  # Half the width of its 95 % confidence interval.
        "value": float,  # The mean.
    },
)

# A measure of the contact conditions; `docs/checks.md` defines each.
Measure = Literal["penetration", "tension", "complementarity", "cone", "adhesion_slip", "mu_error", "mu_error_uncertain", "law_error", "law_error_own", "law_error_slip_state", "direction", "direction_slip_state", "wrong_direction", "dissipation", "violating_fraction", "violating_fraction_slip_state", "roughness_ratio", "law_scatter", "switching_rate", "mesh_mode"]

# Whether slip and the elements below the contact show a mode of the mesh.
MeshMode = TypedDict(
    "MeshMode",
    {
        "alternating_slip": float | None,  # slip that alternates from node to node over all slip (1)
        "alternating_slip_limit": float,  # beyond this it is a mode of the mesh, or not resolved (1)
        "hourglass_energy_in_layers": float | None,  # hourglass over strain energy of the elements below the contact (1)
        "hourglass_energy_limit": float,  # beyond this they deform by modes of the mesh (1)
        "warnings": list[str],  # what is wrong with them
    },
)

# Slip that alternates from node to node, and where it was measured.
MeshModeFound = TypedDict(
    "MeshModeFound",
    {
        "alternating_slip": float | None,  # slip that alternates from node to node over all slip (1)
        "alternating_slip_limit": float,  # beyond this it is a mode of the mesh, or not resolved (1)
        "from": str,  # The summary of the run, or its contact records.
        "hourglass_energy_in_layers": float | None,  # hourglass over strain energy of the elements below the contact (1)
        "hourglass_energy_limit": float,  # beyond this they deform by modes of the mesh (1)
        "warnings": list[str],  # what is wrong with them
    },
)

# A fine zone that follows the contact.
MeshWindow = TypedDict(
    "MeshWindow",
    {
        "energy": float,  # brought by its moves, less what was taken (J)
        "travel": float,  # how far the fine zone has moved (m)
    },
)

# The kind of method that limits are for.
MethodKind = Literal["exact", "penalty"]

# A measure of the contact conditions over the window.
Metric = TypedDict(
    "Metric",
    {
        "about": str,  # Its definition.
        "by_springs": NotRequired[bool],  # Whether penalty springs that deform in stick take it beyond its limit: what is left of it where the algorithm's state is slip keeps its limit, or is at most a tenth of it.
        "deviation": float | None,  # Standard deviation over the records of the same statistic of single records.
        "limit": Limit | None,  # Its limit.
        "note": NotRequired[str | None],  # Why there is no value.
        "pairing": Pairing | None,  # The pairing that the value is of.
        "pass": bool,  # Whether it is within its limit. Without a value it fails only where the user set the limit.
        "per_node_and_microsecond": NotRequired[float | None],  # Switches per node and microsecond, of `switching_rate`.
        "side": View | None,  # The part of the interface that the value is of.
        "sides": NotRequired[Sides | None],  # The statistics of all parts of the interface.
        "statistic": str,  # The statistic over nodes and times that it is.
        "units": str,  # Unit of its value.
        "value": float | None,  # Its value; none where it could not be measured, or is infinite.
        "where": Place | None,  # Where and when it is worst.
    },
)

# The dimensionless numbers of contact and friction; docs/theory.md defines them.
Numbers = TypedDict(
    "Numbers",
    {
        "expect": str | None,  # what to expect of the run, where there is reason for a warning
        "f_min": float | None,  # least coefficient of friction that the falling law reaches (1)
        "gamma": float | None,  # Gamma = l_slip/h_n (1)
        "impedance": float | None,  # rho c_s of both bodies in series (Pa s/m)
        "n1": float | None,  # N_1 = dt^2 k_t/m*, stiffness of the friction springs in a time step (1)
        "n2": float | None,  # N_2, steepness of falling friction in a time step (1)
        "nucleation_length": float | None,  # h_n, nucleation length of friction with memory (m)
        "pressure": float | None,  # p, the pressure at which the numbers hold: Hertz's peak pressure (Pa)
        "r": float | None,  # R, steepness of falling friction: above 1 it has several solutions without memory (1)
        "s_jump": float | None,  # slip velocity to which a node jumps from rest (m/s)
        "s_m": float | None,  # slip velocity at that coefficient (m/s)
        "slip_length": float | None,  # l_slip, length of the zone of slip by Carter's theory (m)
        "stable_memory": float | None,  # memory of friction from which steady rolling is stable (m)
    },
)

# The statistics of a measure on a part of the interface.
OnView = dict[str, Statistics] | Statistics

# Whether a record at t^n holds, beside its tractions, the slip velocity of the step that ends at t^n or of the step that begins there.
Pairing = Literal["before", "after"]

# Which slip velocity a traction is paired with in time.
PairingUsed = TypedDict(
    "PairingUsed",
    {
        "enforced_on": View | None,  # The body at whose nodes the conditions are enforced, where the file says it.
        "in_file": Pairing,  # That of each record of the file.
        "records_with_the_other": int,  # Number of records of which the other pairing is measured too.
        "reported": Reported,  # The pairing that the values are of.
        "stated_by_file": bool,  # Whether the file states it as its method's own.
    },
)

# A mean of the patch over the window.
PatchMean = TypedDict(
    "PatchMean",
    {
        "about": str,  # What it is.
        "ci95": float | None,  # Half the width of the 95 % confidence interval of the mean.
        "deviation": float | None,  # Standard deviation over the records.
        "from": str,  # Where it comes from: the summary, the history or the contact records.
        "mean": float | None,  # The mean; none where no record has a value.
        "note": NotRequired[str | None],  # Why there is no mean, or which rows it leaves out.
        "units": str,  # Its unit.
    },
)

# A measure of the patch.
PatchMeasure = Literal["half_length", "half_width", "centre", "peak_pressure", "peak_pressure_raw", "peak_shear", "area", "area_fitted", "normal_force", "tangential_force", "lateral_force", "traction_coefficient", "stick_fraction", "slip_fraction", "power", "creepage"]

# Where and when a measure is worst.
Place = TypedDict(
    "Place",
    {
        "mu_law": NotRequired[float | None],  # The coefficient of the law there.
        "mu_used": NotRequired[float | None],  # The coefficient that the algorithm used there, of `mu_error` and `mu_error_uncertain`.
        "node": int | None,  # Index of the node in the file.
        "pairing": Pairing | None,  # The pairing.
        "position": list[float] | None,  # Its reference position (m).
        "side": View,  # The part of the interface.
        "time": float,  # Time (s).
        "value": float | None,  # The value there; none where it is infinite.
    },
)

# The rule of the time step of a sweep.
PlannedStep = TypedDict(
    "PlannedStep",
    {
        "rule": str | None,  # `fixed` or `bound`; none where the cases give it.
        "step": float | None,  # The step of all runs (s), with `fixed`.
    },
)

# Means over the checks of an ensemble's members.
PointCheck = TypedDict(
    "PointCheck",
    {
        "metrics": dict[Measure, MeanValue],  # Of the measures.
        "patch": dict[PatchMeasure, MeanOfMeans],  # Of the patch.
        "slip_zone": dict[SlipQuantity, MeanValue],  # Of the slip zone.
    },
)

# Half the widths of the 95 % confidence intervals of a point's window.
PointHalves = TypedDict(
    "PointHalves",
    {
        "from": float | None,  # Of its ends (s).
        "to": float | None,  # See `from`.
        "normal_force": NotRequired[float],
        "tangential_force": NotRequired[float],
        "lateral_force": NotRequired[float],
        "traction_coefficient": NotRequired[float],
        "creepage": NotRequired[float],
        "patch_half_length": NotRequired[float],
        "patch_half_width": NotRequired[float],
        "patch_area": NotRequired[float],
        "patch_area_fitted": NotRequired[float],
        "peak_pressure": NotRequired[float],
        "stick_fraction": NotRequired[float],
        "slip_fraction": NotRequired[float],
        "stick_border": NotRequired[float],
        "peak_shear": NotRequired[float],
        "torque": NotRequired[float],
        "max_penetration": NotRequired[float],
        "hourglass_share": NotRequired[float],
        "friction_power": NotRequired[float],
    },
)

# Means over the summaries of an ensemble's members.
PointSummary = TypedDict(
    "PointSummary",
    {
        "contact": dict[Mean, float],  # Means of the section `contact`.
        "dt": float | None,  # Time step of the first (s): the members differ in it by no more than their disturbance.
        "window": PointWindow,  # Means of the section `window`.
    },
)

# Means over the section `window` of an ensemble's members.
PointWindow = TypedDict(
    "PointWindow",
    {
        "ci95": PointHalves,  # Half the width of the 95 % confidence intervals of all means.
        "from": float | None,  # Its ends (s).
        "to": float | None,  # See `from`.
        "normal_force": NotRequired[float],
        "tangential_force": NotRequired[float],
        "lateral_force": NotRequired[float],
        "traction_coefficient": NotRequired[float],
        "creepage": NotRequired[float],
        "patch_half_length": NotRequired[float],
        "patch_half_width": NotRequired[float],
        "patch_area": NotRequired[float],
        "patch_area_fitted": NotRequired[float],
        "peak_pressure": NotRequired[float],
        "stick_fraction": NotRequired[float],
        "slip_fraction": NotRequired[float],
        "stick_border": NotRequired[float],
        "peak_shear": NotRequired[float],
        "torque": NotRequired[float],
        "max_penetration": NotRequired[float],
        "hourglass_share": NotRequired[float],
        "friction_power": NotRequired[float],
    },
)

# Where a wheel with profiles touches the rail, and what it slips by its position.
Position = TypedDict(
    "Position",
    {
        "lateral": float,  # lateral creepage by the position (1)
        "longitudinal": float,  # longitudinal creepage by the position (1)
        "plane_angle": float,  # slope of the plane of contact, positive where it rises in +y (rad)
        "rail_y": float,  # y of the first point of contact on the profile of the rail (m)
        "rolling_radius": float,  # distance of the first point of contact from the axle (m)
        "spin": float,  # spin by the position (1/m)
        "wheel_y": float,  # y of the first point of contact on the profile of the wheel (m)
    },
)

# How the preload was found.
Preload = TypedDict(
    "Preload",
    {
        "cg_iterations": int | None,  # iterations of conjugate gradients, of a static preload (1)
        "closed_pairs": int | None,  # contact points that are closed, of a static preload (1)
        "facet_residual": float | None,  # the same once normals that had to be held follow the facets again (1)
        "hub_displacement": float,  # displacement of the hub in z (m)
        "iterations": int,  # iterations of Newton's method, or of the relaxation (1)
        "kinetic_ratio": float | None,  # fictitious kinetic over internal energy at the end, of relaxation (1)
        "method": str,  # `static` or `relaxation`
        "normal_force": float,  # sum of the contact's normal forces (N)
        "residual": float | None,  # residual force over the load at the end, of a static preload (1)
    },
)

# The pairing that the values of a check are of.
Reported = Literal["before", "after", "stricter"]

# Rolling radii of the disk.
RollingRadius = TypedDict(
    "RollingRadius",
    {
        "effective": float,  # R_eff, V over the omega at which the slip averaged over the preloaded patch is zero (m)
        "free": float | None,  # V over the omega of free rolling, where drive.torque = 0 (m)
        "nominal": float,  # radius of the undeformed disk (m)
    },
)

# A scale of the measures.
ScaleUsed = TypedDict(
    "ScaleUsed",
    {
        "about": str,  # What it is.
        "from": str,  # Its origin.
        "units": str,  # Its unit.
        "value": float,  # Its value.
    },
)

# The statistics of a measure on all parts of the interface.
Sides = dict[str, Any] | dict[str, OnView]

# A statistic of slip over the slip zone.
SlipQuantity = Literal["mean", "fluctuation", "fluctuating_share", "fluctuating_share_of_elements", "largest", "correlation_length", "correlation_time", "mean_wavenumber", "mean_frequency"]

# The value of a statistic of slip.
SlipStatistic = TypedDict(
    "SlipStatistic",
    {
        "about": str,  # What it is.
        "ci95": float | None,  # Half the width of its 95 % confidence interval.
        "deviation": float | None,  # Standard deviation over the records of the same statistic of single records.
        "note": NotRequired[str | None],  # Why there is no value, or no interval.
        "units": str,  # Its unit.
        "value": float | None,  # Its value; none where the records do not resolve it.
    },
)

# Statistics of slip over the slip zone, or why there are none.
SlipZoneFound = dict[str, Any] | SlipZoneMeasured

# Statistics of slip over the slip zone; docs/checks.md defines them.
SlipZoneMeasured = TypedDict(
    "SlipZoneMeasured",
    {
        "from": float | None,  # Rear end of the zone (m).
        "to": float | None,  # Front end of the zone (m).
        "mean": NotRequired[SlipStatistic],
        "fluctuation": NotRequired[SlipStatistic],
        "fluctuating_share": NotRequired[SlipStatistic],
        "fluctuating_share_of_elements": NotRequired[SlipStatistic],
        "largest": NotRequired[SlipStatistic],
        "correlation_length": NotRequired[SlipStatistic],
        "correlation_time": NotRequired[SlipStatistic],
        "mean_wavenumber": NotRequired[SlipStatistic],
        "mean_frequency": NotRequired[SlipStatistic],
    },
)

# What half-spaces took.
Spectral = TypedDict(
    "Spectral",
    {
        "faded": float,  # share of the static compliance that is felt at its static value from then on (1)
        "grid": list[int],  # points along x and y
        "inertia": bool,  # whether the half-spaces have inertia
        "iterations_per_step": float,  # mean iterations of a step (1)
        "megabytes": float,  # memory of the half-spaces (MB)
        "memory_steps": int,  # steps of the past that are felt (1)
        "most_iterations": int,  # most iterations of a step (1)
        "undelayed_steps": int,  # steps in which a point that stuck began to slip although adhesion was a solution (1)
    },
)

# The frequencies that limit the time step.
Stability = TypedDict(
    "Stability",
    {
        "dt_limit": float,  # longest stable time step: 2/omega_max, less with Kelvin-Voigt damping (s)
        "factor": float,  # time step over that limit (1)
        "omega_bound": float,  # rigorous upper bound of omega_max, by the bounds of the elements and of the contact springs (rad/s)
        "omega_elastic": float,  # largest frequency of the bodies without contact, with margin (rad/s)
        "omega_max": float,  # largest frequency with the springs of contact closed after the preload, with margin (rad/s)
    },
)

# A value with further statistics.
Statistics = TypedDict(
    "Statistics",
    {
        "value": float | None,  # The value of the measure.
        "mean": NotRequired[float | None],
        "median": NotRequired[float | None],
        "rms": NotRequired[float | None],
        "p95": NotRequired[float | None],
        "max": NotRequired[float | None],
        "rms_slip_state": NotRequired[float | None],
        "energy": NotRequired[float | None],
        "deviation_traction": NotRequired[float | None],
        "deviation_law": NotRequired[float | None],
        "deviation_slip": NotRequired[float | None],
        "mu_used": NotRequired[float | None],
        "mu_law": NotRequired[float | None],
        "mu_used_worst": NotRequired[float | None],
        "mu_law_worst": NotRequired[float | None],
        "uncertainty_median": NotRequired[float | None],
        "uncertainty_rms": NotRequired[float | None],
        "uncertainty_p95": NotRequired[float | None],
    },
)

# How a run ended.
Status = Literal["completed", "interrupted", "failed"]

# Stress over the depth on the axis of the patch in one body, at the last record of `fields.vtkhdf`.
StressProfile = TypedDict(
    "StressProfile",
    {
        "body": str,  # The body, `disk` or `bar`.
        "contact_time": float,  # Time of the record of the tractions, the nearest to it (s).
        "depth": NDArray[np.float64],  # Depths below the surface, at the centroids of the elements (m).
        "elements": Stresses,  # Stress of the elements.
        "half_length": float | None,  # Hertz's half axis along x (m).
        "half_space": Stresses,  # Stress of a half-space under the pressure and shear that the run has on this body.
        "hertz": Stresses | None,  # Stress of a half-space under Hertz's pressure without shear; none where Hertz's patch is not known.
        "peak_pressure": float | None,  # Hertz's peak pressure (Pa).
        "time": float,  # Time of the record of the bodies (s).
        "x": float,  # x of the axis, the centre of the patch (m).
    },
)

# Stresses at the depths of a profile (Pa), tension positive; x rolls, y is lateral, z is up.
Stresses = TypedDict(
    "Stresses",
    {
        "hydrostatic": NDArray[np.float64],  # A third of the trace.
        "max_shear": NDArray[np.float64],  # Largest shear stress, half of largest less smallest principal stress.
        "von_mises": NDArray[np.float64],  # Von Mises stress.
        "xx": NDArray[np.float64],  # Normal stress along x.
        "xz": NDArray[np.float64],  # Shear stress.
        "yy": NDArray[np.float64],  # Normal stress along y.
        "zz": NDArray[np.float64],  # Normal stress along z.
    },
)

# The summary of a run at its end; numbers in SI units unless a field says otherwise.
Summary = TypedDict(
    "Summary",
    {
        "case_hash": NotRequired[str | None],  # hash of the resolved case
        "checks": NotRequired[Checks | None],  # errors of the solution
        "checksums": NotRequired[dict[str, FileSum] | None],  # lengths and checksums of the files
        "contact": Contact,  # means over the evaluation window
        "created": NotRequired[str | None],  # when the run started, ISO 8601 in UTC
        "creepage_version": NotRequired[str | None],  # version of the program that wrote the file
        "diagnosis": NotRequired[str | None],  # why its own guards stopped it, and what to do
        "dt": float,  # time step (s)
        "element_steps_per_s": float,  # elements times steps over the wall-clock time of the time loop (1/s)
        "elements": int,  # elements of both bodies (1)
        "energy": Energy,  # energies at the end of the run
        "exact_contact": ExactContact | None,  # exact enforcement; null without it
        "files": Files,  # files of the run, relative to its folder
        "friction_law": NotRequired[list[list[float]] | None],  # Samples of a friction law that the user supplied as a function: pairs of slip speed (m/s) and coefficient of friction
        "half_space": NotRequired[HalfSpace | None],  # Hertz's contact
        "implicit": Implicit | None,  # implicit steps; null of explicit ones
        "kernels": NotRequired[str | None],  # the instructions that the kernels used
        "mesh_mode": NotRequired[MeshMode | None],  # modes of the mesh
        "mesh_window": NotRequired[MeshWindow | None],  # a fine zone that follows the contact
        "model": NotRequired[str | None],  # `half-space`, of half-spaces
        "name": str,  # name of the case
        "names": NotRequired[dict[str, str]],  # what each number is, by its dotted key
        "nodes": int,  # nodes of both bodies (1)
        "numbers": NotRequired[Numbers | None],  # dimensionless numbers
        "peak_rss_mb": float,  # largest resident memory of the process (MB)
        "position": NotRequired[Position | None],  # the position of a wheel with profiles
        "preload": Preload | None,  # the preload; null without one
        "rolling_radius": NotRequired[RollingRadius | None],  # rolling radii of the disk
        "sha256": NotRequired[str | None],  # checksum of the summary without this key
        "spectral": NotRequired[Spectral | None],  # half-spaces
        "stability": NotRequired[Stability | None],  # frequencies that limit the time step
        "stages": dict[str, float],  # wall-clock time of each stage of the run (s)
        "status": NotRequired[Status | None],  # how the run ended
        "steps": int,  # time steps taken (1)
        "symmetry": NotRequired[str | None],  # whether half of the bodies is modelled
        "t_end": float,  # simulated time reached (s)
        "threads": int,  # threads used (1)
        "time_loop_bytes_per_element": float | None,  # memory of the time loop over the elements (B)
        "units": NotRequired[dict[str, str]],  # unit of each number, by its dotted key
        "wall_s": float,  # wall-clock time of the run (s)
        "window": NotRequired[Window | None],  # the evaluation window
    },
)

# A point of a sweep with an ensemble: means over the members that completed, with half the width of the 95 % confidence intervals of these means (Student 1908).
SweepPoint = TypedDict(
    "SweepPoint",
    {
        "check": PointCheck,  # Means of their checks.
        "completed": int,  # How many completed.
        "members": list[str],  # Names of its members.
        "parameters": dict[str, Any],  # Values of the swept keys but for that of the members.
        "run": str | None,  # Folder of the first that completed.
        "status": str,  # `completed` where more than one member did: one alone has no interval.
        "summary": PointSummary,  # Means of their summaries.
    },
)

# `sweep.json`: what the sweep does, and what its runs gave.
SweepResult = TypedDict(
    "SweepResult",
    {
        "axes": dict[str, Any],  # Values of each axis.
        "base": str,  # Path of the case that it varies.
        "creepage_version": str,  # Version of the program that laid it out.
        "ensemble": str | None,  # Key of the axis of the members of an ensemble, where there is one.
        "file": str,  # Path of the sweep file.
        "hash": str,  # SHA-256 of its cases and the rule of the step: what identifies it.
        "mode": str,  # `grid` or `zip`.
        "name": str,  # Its name.
        "not_repeated": list[str],  # Fields of summaries that another run of the same sweep does not repeat.
        "parameters": list[str],  # Keys of the axes.
        "points": list[SweepPoint],  # Of a sweep with an ensemble its points, means over their members.
        "runs": list[SweepRun],  # Its runs.
        "step": PlannedStep,  # The rule of the time step.
        "title": str | None,  # Its title.
    },
)

# A run of a sweep.
SweepRun = TypedDict(
    "SweepRun",
    {
        "check": CheckResult | None,  # What its check found.
        "name": str | None,  # Name of its folder and of its case.
        "parameters": dict[str, Any],  # Values of the swept keys.
        "reason": NotRequired[str | None],  # Why it failed.
        "run": str | None,  # Its folder, relative to that of the sweep.
        "status": str | None,  # How far it is: `completed`, `failed`, or why it is neither.
        "summary": Summary | None,  # Its summary.
    },
)

# Tolerances of the conditions at a node.
Tolerances = TypedDict(
    "Tolerances",
    {
        "direction": float,  # Angle (degrees) above which the direction is.
        "in_adhesion": float,  # Shear over the bound below which a node is in adhesion.
        "in_contact": float,  # Pressure over p0 above which a node is in contact.
        "law_error": float,  # |p_f/(mu p_n) - 1| above which the law is violated.
    },
)

# A part of the interface.
View = Literal["disk", "bar", "other", "pair", "both"]

# The evaluation window, means over it that [`Contact`] does not hold, and standard deviations.
Window = TypedDict(
    "Window",
    {
        "deviation": dict[Mean, float | None],  # standard deviations of the means
        "friction_power": float | None,  # mean power of friction; T creepage V in steady rolling (W)
        "from": float | None,  # start of the evaluation window (s)
        "hourglass_share": float | None,  # hourglass over strain energy (1)
        "max_penetration": float | None,  # largest penetration (m)
        "peak_shear": float | None,  # largest nodal shear traction on the bar (Pa)
        "reasons": dict[Mean, str],  # why a mean has no value, or how many rows of the history it leaves out
        "stick_border": float | None,  # rear end of the longest stick zone on y = 0 from the centre of the patch (m)
        "to": float | None,  # end of the evaluation window (s)
        "torque": float | None,  # torque that the drive supplies about y (N m)
        "warnings": list[str],  # what is wrong with the means
    },
)
