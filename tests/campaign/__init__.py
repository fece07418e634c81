"""The campaign: bad inputs and faults against the whole studio, drawn from a seed and counted.

rest     requests over the description (schemathesis) and of an own generator, to a server in a process of its own
files    every kind of file, unpacked, mutated and packed again, read in a process with limits of time and memory
faults   kills, full disks, locks, damage, lost and slow sockets, steps of the clock, applications that misbehave
soak     live runs begun and ended, and what a server holds while they come and go

`python -m tests.campaign --help` starts the long form, which prints a table; test_campaign.py is the short one.
"""
