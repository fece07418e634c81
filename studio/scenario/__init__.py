"""Scenarios: what a user may write, the catalogue of vehicles and tyres, changes by path."""
