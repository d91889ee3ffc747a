"""turtlesim under upstream's names: messages, services, node; its rules are in turtlesim.pond."""
