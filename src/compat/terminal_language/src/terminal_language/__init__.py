"""What our programs print on a terminal, in the language of the locale (README.md)."""
