"""Applications: the contract, the registry, the hosts, and the built-ins that come in by the same door."""
