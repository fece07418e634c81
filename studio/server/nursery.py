"""What processes of runs are split off: a process that has imported everything, and called everything once that is compiled. It is
started when there is machine code of all that, for what it does not hold each of them would have to load.

It imports this file and does nothing else; each process split off it shares its memory until it writes to it.
"""

import gc
import signal

from studio import sample
from studio.server import worker

signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server decides when it ends
worker.warm(sample.first())
gc.collect()
gc.freeze()  # a collection would touch, and so copy, all that is shared
