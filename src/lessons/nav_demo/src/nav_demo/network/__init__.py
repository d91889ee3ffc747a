"""The checks of check_network: whether several machines can communicate."""
