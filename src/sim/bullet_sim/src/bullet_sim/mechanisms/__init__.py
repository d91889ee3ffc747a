"""What holds, joins or moves links and joints, and is no drive train: grippers, lifts, winches."""
