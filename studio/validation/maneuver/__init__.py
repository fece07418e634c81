"""Maneuvers, a file each: what is fed, what is judged, how one is found in a long log, aligned and measured.

    TITLE, STEP     for people, and the step of the method that it belongs to
    FED             our signals of which one each must be there, alternatives with a stroke: "road_wheel_angle|steering_wheel_angle"
    JUDGED          our signals that are compared
    HOLDS_SPEED     whether the recorded speed is held in the simulation, for the driver did so
    REPEATS         whether its runs are repetitions, which can be averaged
    ZONES           signals whose data zone is judged
    UNJUDGED        what its criteria say nothing about, in words, so that nobody takes all of them for everything
    find            find(recording) -> [(since, until)] [s] of such maneuvers in a log
    marks           marks(recording) -> Marks: the reference that runs are aligned by, and what else is read off the inputs
    measures        measures(recording, marks) -> {name: (value, rule, unit)}, the same for a recorded and a simulated run

and, where runs have to be looked at together,

    compare         compare(theirs, ours, averaged) -> [Measure]
    share           share(theirs, ours, confidence) -> {name: share of a zone that the simulations keep inside}
"""
