// The page speaks Chinese or English: the browser's language, or what was chosen by the switch.

const chosen = localStorage.getItem("language");

export const language = chosen ?? (navigator.language.startsWith("zh") ? "zh" : "en");

/** The text in the page's language. */
export function t(english, chinese) {
  return language === "zh" ? chinese : english;
}

/** Turn to the other language; the page loads anew. */
export function switchLanguage() {
  localStorage.setItem("language", language === "zh" ? "en" : "zh");
  location.reload();
}
