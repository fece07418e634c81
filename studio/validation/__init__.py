"""Does our car drive like that car? Recorded maneuvers against their replay: zones, criteria, calibration, span, report.

The method is that of M. Massow and I. Radusch, A Rapid Prototyping Environment for Cooperative Advanced Driver Assistance Systems,
Journal of Advanced Transportation 2018, section 5; its equations are named where they are used.
"""
