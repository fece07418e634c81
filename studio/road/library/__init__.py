"""Maps from where they come to where they are kept: files, downloads, corrections, the folders of imports."""
