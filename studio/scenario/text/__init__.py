"""The text of a scenario file: read with places, changed by patches, undone to the letter, migrated."""
