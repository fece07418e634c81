"""What a garage that drives the cars in it decides with: its plan, ways into spaces, who gets which space, who may drive where."""
